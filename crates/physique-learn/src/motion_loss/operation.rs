//! The operation in Burn's graph.

use std::sync::Arc;

use burn::backend::autodiff::Autodiff;
use burn::backend::autodiff::checkpoint::base::Checkpointer;
use burn::backend::autodiff::checkpoint::strategy::CheckpointStrategy;
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind};
use burn::backend::tensor::FloatTensor;
use burn::backend::{
    AutodiffBackend, Backend, Dispatch, ExtensionType, Flex, TensorMetadata, backend_extension,
};
use burn::tensor::{Shape, Tensor, TensorData};

use super::{LossAndGradient, MotionLoss};

/// The loss of each motion, `[batch]`, of normalised motions `[batch][frames][columns]`.
///
/// One operation: loss and gradient are computed together going forward, so that going back is one
/// product. A motion that is no motion, of NaN for instance, has the loss NaN.
pub fn losses(motions: Tensor<3>, lengths: &[usize], loss: &Arc<dyn MotionLoss>) -> Tensor<1> {
    let motions = motions.into_dispatch();
    let losses = <Dispatch as MotionLossOps>::motion_losses(motions, loss.clone(), lengths.into());
    Tensor::from_dispatch(losses)
}

/// What the backward pass needs.
#[derive(ExtensionType)]
pub(crate) struct LossTensors<B: Backend> {
    /// `[batch]`.
    pub losses: FloatTensor<B>,
    /// As the motions.
    pub gradient: FloatTensor<B>,
}

/// Backends that evaluate a [`MotionLoss`].
#[cfg_attr(not(feature = "cubecl"), backend_extension(Autodiff, Flex))]
#[cfg_attr(feature = "cubecl", backend_extension(Autodiff, Flex, Cube))]
pub(crate) trait MotionLossOps: Backend {
    /// The loss of each motion.
    fn motion_losses(
        motions: FloatTensor<Self>,
        loss: Arc<dyn MotionLoss>,
        lengths: Vec<usize>,
    ) -> FloatTensor<Self>;

    /// The loss of each motion, and the gradient of their sum.
    fn motion_losses_with_gradient(
        motions: FloatTensor<Self>,
        loss: Arc<dyn MotionLoss>,
        lengths: Vec<usize>,
    ) -> LossTensors<Self>;
}

impl MotionLossOps for Flex {
    fn motion_losses(
        motions: FloatTensor<Self>,
        loss: Arc<dyn MotionLoss>,
        lengths: Vec<usize>,
    ) -> FloatTensor<Self> {
        Self::motion_losses_with_gradient(motions, loss, lengths).losses
    }

    fn motion_losses_with_gradient(
        motions: FloatTensor<Self>,
        loss: Arc<dyn MotionLoss>,
        lengths: Vec<usize>,
    ) -> LossTensors<Self> {
        let found = on_processor(motions.to_contiguous().into_data(), &loss, &lengths);
        LossTensors {
            losses: FloatTensor::<Self>::from_data(found.0),
            gradient: FloatTensor::<Self>::from_data(found.1),
        }
    }
}

/// Losses and gradient of the numbers of motions.
fn on_processor(
    motions: TensorData,
    loss: &Arc<dyn MotionLoss>,
    lengths: &[usize],
) -> (TensorData, TensorData) {
    let shape = motions.shape().clone();
    let (batch, frames) = (shape[0], shape[1]);
    let numbers: Vec<f32> = motions.iter::<f32>().collect();
    let found = loss.evaluate(&numbers, frames, lengths);
    // An operation cannot fail; what cannot be measured is no number, which training stops at.
    let LossAndGradient { losses, gradient } = found.unwrap_or_else(|_| LossAndGradient {
        losses: vec![f32::NAN; batch],
        gradient: vec![0.0; numbers.len()],
    });
    let losses = TensorData::new(losses, [batch]);
    (losses, TensorData::new(gradient, shape))
}

#[cfg(feature = "cubecl")]
use burn::backend::ops::FloatTensorOps;

#[cfg(feature = "cubecl")]
impl MotionLossOps for burn_cubecl::CubeBackend {
    fn motion_losses(
        motions: FloatTensor<Self>,
        loss: Arc<dyn MotionLoss>,
        lengths: Vec<usize>,
    ) -> FloatTensor<Self> {
        Self::motion_losses_with_gradient(motions, loss, lengths).losses
    }

    fn motion_losses_with_gradient(
        motions: FloatTensor<Self>,
        loss: Arc<dyn MotionLoss>,
        lengths: Vec<usize>,
    ) -> LossTensors<Self> {
        let kernels = loss.on_gpu().filter(|gpu| gpu.fits(&motions, &lengths));
        let (losses, gradient) = match kernels {
            Some(kernels) => kernels.evaluate(motions, &lengths),
            None => {
                let device = motions.device.clone();
                let data = burn_cubecl::ops::into_data_sync(motions);
                let (losses, gradient) = on_processor(data, &loss, &lengths);
                let load = |data| <Self as FloatTensorOps<Self>>::float_from_data(data, &device);
                (load(losses), load(gradient))
            }
        };
        LossTensors { losses, gradient }
    }
}

/// Going back: each motion's gradient times that of its loss.
#[derive(Debug)]
struct ByMotions;

impl<B: Backend> Backward<B, 1> for ByMotions {
    type State = FloatTensor<B>;

    fn backward(
        self,
        ops: Ops<Self::State, 1>,
        gradients: &mut Gradients,
        _checkpointer: &mut Checkpointer,
    ) {
        let [motions] = ops.parents;
        let by_losses = gradients.consume::<B>(&ops.node);
        if let Some(motions) = motions {
            let batch = by_losses.shape()[0];
            let by_losses = B::float_reshape(by_losses, Shape::new([batch, 1, 1]));
            gradients.register::<B>(motions.id, B::float_mul(ops.state, by_losses));
        }
    }
}

impl<B: MotionLossOps, C: CheckpointStrategy> MotionLossOps for Autodiff<B, C> {
    fn motion_losses(
        motions: FloatTensor<Self>,
        loss: Arc<dyn MotionLoss>,
        lengths: Vec<usize>,
    ) -> FloatTensor<Self> {
        match ByMotions
            .prepare::<C>([motions.node()])
            .compute_bound()
            .stateful()
        {
            OpsKind::Tracked(prepared) => {
                let inner = motions.primitive().clone();
                let found = B::motion_losses_with_gradient(inner, loss, lengths);
                prepared.finish(found.gradient, found.losses)
            }
            OpsKind::UnTracked(prepared) => {
                let inner = motions.into_primitive();
                prepared.finish(B::motion_losses(inner, loss, lengths))
            }
        }
    }

    fn motion_losses_with_gradient(
        motions: FloatTensor<Self>,
        loss: Arc<dyn MotionLoss>,
        lengths: Vec<usize>,
    ) -> LossTensors<Self> {
        // Not differentiated twice: both are constants.
        let found = B::motion_losses_with_gradient(motions.into_primitive(), loss, lengths);
        LossTensors {
            losses: Self::from_inner(found.losses),
            gradient: Self::from_inner(found.gradient),
        }
    }
}
