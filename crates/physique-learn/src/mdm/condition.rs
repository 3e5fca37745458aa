//! What a batch of motions is to be.

use burn::tensor::{Bool, Device, Tensor, TensorData};

use crate::Error;
use crate::tensors::tensor;
use crate::text::Embeddings;

/// What each motion of a batch is to be, in the terms of [`super::ConditionKind`].
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "there is one a batch")]
pub enum Condition {
    /// Anything.
    Nothing,
    /// What captions say.
    Text {
        /// `[batch][tokens][width]`.
        tokens: Tensor<3>,
        /// `[batch][tokens]`: true for padding; `None` where there is none.
        padding: Option<Tensor<2, Bool>>,
    },
    /// Numbers of actions.
    Actions(Vec<usize>),
}

impl Condition {
    /// Captions as an encoder gave them, on a device.
    ///
    /// # Errors
    /// [`Error::Input`] when the counts disagree.
    pub fn text(embeddings: &Embeddings, device: &Device) -> Result<Self, Error> {
        let Embeddings {
            batch,
            tokens,
            width,
            ref values,
            ref padding,
        } = *embeddings;
        if values.len() != batch * tokens * width || padding.len() != batch * tokens {
            let expected = format!("{batch} x {tokens} vectors of {width}, and a mask for them");
            let found = format!("{} numbers and {} marks", values.len(), padding.len());
            return Err(Error::input("Embeddings", expected, found));
        }
        let hidden = padding.iter().any(|&hidden| hidden).then(|| {
            let data = TensorData::new(padding.clone(), [batch, tokens]);
            Tensor::from_data(data, device)
        });
        Ok(Self::Text {
            tokens: tensor(values.clone(), [batch, tokens, width], device),
            padding: hidden,
        })
    }
}
