//! An operation on plain numbers in Burn's graph.

use std::array::from_fn;
use std::fmt::Debug;
use std::sync::Arc;

use burn::backend::autodiff::Autodiff;
use burn::backend::autodiff::checkpoint::base::Checkpointer;
use burn::backend::autodiff::checkpoint::strategy::CheckpointStrategy;
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind};
use burn::backend::tensor::FloatTensor;
use burn::backend::{AutodiffBackend, Backend, Dispatch, Flex, TensorMetadata, backend_extension};
use burn::tensor::{Device, Shape, Tensor, TensorData};

/// A function of tensors and its derivative, on their numbers.
pub(crate) trait Operation: Debug + Send + Sync + 'static {
    /// How many inputs there are: 1 to 3.
    fn inputs(&self) -> usize;

    /// The output.
    fn forward(&self, inputs: &[&[f32]]) -> Forward;

    /// Derivatives by each input, from the one by the output. `kept` is what [`Forward::kept`] was.
    fn backward(&self, inputs: &[&[f32]], kept: &[f32], by_output: &[f32]) -> Vec<Vec<f32>>;

    /// The output's shape from that of the first input.
    fn shape(&self, input: Shape) -> Shape {
        input
    }

    /// Whether the way back reads the inputs' numbers.
    fn reads_inputs(&self) -> bool {
        true
    }
}

/// Changes numbers of four tensors of one shape.
pub(crate) trait Change: Debug + Send + Sync + 'static {
    /// Changes them; all slices are as long.
    fn apply(&self, tensors: [&mut [f32]; 4]);
}

/// What an [`Operation`] computes.
pub(crate) struct Forward {
    /// The output's numbers.
    pub(crate) output: Vec<f32>,
    /// Numbers that the way back needs besides the inputs.
    pub(crate) kept: Vec<f32>,
}

/// Whether a device computes with plain numbers in memory.
pub(crate) fn is_supported(device: &Device) -> bool {
    device.clone().inner() == Device::flex()
}

/// Applies an operation to as many inputs as it has.
pub(super) fn apply<const D: usize>(
    operation: impl Operation,
    inputs: Vec<FloatTensor<Dispatch>>,
) -> Tensor<D> {
    let [a, b, c] = from_fn(|index| inputs[index.min(inputs.len() - 1)].clone());
    drop(inputs);
    Tensor::from_dispatch(<Dispatch as FusedOps>::fused(a, b, c, Arc::new(operation)))
}

/// A tensor among the inputs of an operation.
pub(super) fn input<const D: usize>(tensor: Tensor<D>) -> FloatTensor<Dispatch> {
    tensor.into_dispatch()
}

/// Four tensors of one shape, outside of any graph, after a change.
pub(crate) fn changed<const D: usize>(
    tensors: [Tensor<D>; 4],
    change: impl Change,
) -> [Tensor<D>; 4] {
    let [a, b, c, d] = tensors.map(Tensor::into_dispatch);
    let (a, b, c, d) = <Dispatch as FusedOps>::change_in_place(a, b, c, d, Arc::new(change));
    [a, b, c, d].map(Tensor::from_dispatch)
}

/// Backends that run an [`Operation`]. Where it has fewer than three inputs, the others are any.
#[backend_extension(Autodiff, Flex)]
pub(crate) trait FusedOps: Backend {
    /// The output.
    fn fused(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        operation: Arc<dyn Operation>,
    ) -> FloatTensor<Self>;

    /// The output, and what is kept for the way back.
    fn fused_forward(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        operation: Arc<dyn Operation>,
    ) -> Vec<FloatTensor<Self>>;

    /// Derivatives by each input.
    fn fused_backward(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        kept: FloatTensor<Self>,
        by_output: FloatTensor<Self>,
        operation: Arc<dyn Operation>,
    ) -> Vec<FloatTensor<Self>>;

    /// Changes the numbers of tensors of one shape, in place where nobody else has them; outside
    /// of any graph.
    fn change_in_place(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        d: FloatTensor<Self>,
        change: Arc<dyn Change>,
    ) -> (
        FloatTensor<Self>,
        FloatTensor<Self>,
        FloatTensor<Self>,
        FloatTensor<Self>,
    );
}

impl FusedOps for Flex {
    fn fused(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        operation: Arc<dyn Operation>,
    ) -> FloatTensor<Self> {
        Self::fused_forward(a, b, c, operation).swap_remove(0)
    }

    fn fused_forward(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        operation: Arc<dyn Operation>,
    ) -> Vec<FloatTensor<Self>> {
        let inputs = [a, b, c].map(|input| input.to_contiguous());
        let shape = operation.shape(inputs[0].shape());
        let numbers = inputs.each_ref().map(|input| input.storage::<f32>());
        let Forward { output, kept } = operation.forward(&numbers[..operation.inputs()]);
        let kept_shape = Shape::new([kept.len()]);
        vec![flex(output, shape), flex(kept, kept_shape)]
    }

    fn fused_backward(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        kept: FloatTensor<Self>,
        by_output: FloatTensor<Self>,
        operation: Arc<dyn Operation>,
    ) -> Vec<FloatTensor<Self>> {
        let tensors = [a, b, c, kept, by_output].map(|tensor| tensor.to_contiguous());
        let [a, b, c, kept, by_output] = tensors.each_ref().map(|tensor| tensor.storage::<f32>());
        let inputs = &[a, b, c][..operation.inputs()];
        let gradients = operation.backward(inputs, kept, by_output).into_iter();
        let gradients = gradients.map(|gradient| {
            let shape = Shape::new([gradient.len()]);
            flex(gradient, shape)
        });
        gradients.collect()
    }

    fn change_in_place(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        d: FloatTensor<Self>,
        change: Arc<dyn Change>,
    ) -> (
        FloatTensor<Self>,
        FloatTensor<Self>,
        FloatTensor<Self>,
        FloatTensor<Self>,
    ) {
        let mut tensors = [a, b, c, d].map(|tensor| {
            // Only one of the two may be left, or the numbers would be shared and copied.
            let contiguous = tensor.to_contiguous();
            drop(tensor);
            contiguous
        });
        change.apply(tensors.each_mut().map(|tensor| tensor.storage_mut::<f32>()));
        tensors.into()
    }
}

fn flex(numbers: Vec<f32>, shape: Shape) -> FloatTensor<Flex> {
    FloatTensor::<Flex>::from_data(TensorData::new(numbers, shape))
}

/// Going back.
#[derive(Debug)]
struct FusedBackward;

/// What going back needs.
#[derive(Clone, Debug)]
struct State<B: Backend> {
    /// Three inputs and what was kept, or that alone.
    tensors: Vec<FloatTensor<B>>,
    shapes: Vec<Shape>,
    operation: Arc<dyn Operation>,
}

impl<B: FusedOps, const N: usize> Backward<B, N> for FusedBackward {
    type State = State<B>;

    fn backward(
        self,
        ops: Ops<Self::State, N>,
        gradients: &mut Gradients,
        _checkpointer: &mut Checkpointer,
    ) {
        let by_output = gradients.consume::<B>(&ops.node);
        let State {
            mut tensors,
            shapes,
            operation,
        } = ops.state;
        let kept = tensors.pop().unwrap_or_else(|| by_output.clone());
        let [a, b, c] = from_fn(|index| tensors.get(index).unwrap_or(&kept).clone());
        drop(tensors);
        let found = B::fused_backward(a, b, c, kept, by_output, operation);
        for ((parent, gradient), shape) in ops.parents.into_iter().zip(found).zip(shapes) {
            if let Some(parent) = parent {
                gradients.register::<B>(parent.id, B::float_reshape(gradient, shape));
            }
        }
    }
}

/// The operation with its way back in the graph.
fn tracked<B: FusedOps, C: CheckpointStrategy, const N: usize>(
    inputs: [FloatTensor<Autodiff<B, C>>; 3],
    operation: Arc<dyn Operation>,
) -> FloatTensor<Autodiff<B, C>> {
    let nodes = from_fn(|index| inputs[index].node());
    let shapes = inputs.each_ref().map(|input| input.primitive().shape());
    let [a, b, c] = inputs.map(|input| input.into_primitive());
    match Backward::<B, N>::prepare::<C>(FusedBackward, nodes)
        .compute_bound()
        .stateful()
    {
        OpsKind::Tracked(prepared) => {
            let mut tensors = match operation.reads_inputs() {
                true => vec![a.clone(), b.clone(), c.clone()],
                false => Vec::new(),
            };
            let mut outputs = B::fused_forward(a, b, c, operation.clone());
            let output = outputs.swap_remove(0);
            tensors.append(&mut outputs);
            let state = State {
                tensors,
                shapes: shapes.into(),
                operation,
            };
            prepared.finish(state, output)
        }
        OpsKind::UnTracked(prepared) => prepared.finish(B::fused(a, b, c, operation)),
    }
}

impl<B: FusedOps, C: CheckpointStrategy> FusedOps for Autodiff<B, C> {
    fn fused(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        operation: Arc<dyn Operation>,
    ) -> FloatTensor<Self> {
        match operation.inputs() {
            1 => tracked::<B, C, 1>([a, b, c], operation),
            2 => tracked::<B, C, 2>([a, b, c], operation),
            _ => tracked::<B, C, 3>([a, b, c], operation),
        }
    }

    fn fused_forward(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        operation: Arc<dyn Operation>,
    ) -> Vec<FloatTensor<Self>> {
        let [a, b, c] = [a, b, c].map(|input| input.into_primitive());
        let found = B::fused_forward(a, b, c, operation).into_iter();
        found.map(Self::from_inner).collect()
    }

    fn fused_backward(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        kept: FloatTensor<Self>,
        by_output: FloatTensor<Self>,
        operation: Arc<dyn Operation>,
    ) -> Vec<FloatTensor<Self>> {
        // Not differentiated twice: derivatives are constants.
        let tensors = [a, b, c, kept, by_output].map(|tensor| tensor.into_primitive());
        let [a, b, c, kept, by_output] = tensors;
        let found = B::fused_backward(a, b, c, kept, by_output, operation);
        found.into_iter().map(Self::from_inner).collect()
    }

    fn change_in_place(
        a: FloatTensor<Self>,
        b: FloatTensor<Self>,
        c: FloatTensor<Self>,
        d: FloatTensor<Self>,
        change: Arc<dyn Change>,
    ) -> (
        FloatTensor<Self>,
        FloatTensor<Self>,
        FloatTensor<Self>,
        FloatTensor<Self>,
    ) {
        let [a, b, c, d] = [a, b, c, d].map(|tensor| tensor.into_primitive());
        let (a, b, c, d) = B::change_in_place(a, b, c, d, change);
        [a, b, c, d].map(Self::from_inner).into()
    }
}
