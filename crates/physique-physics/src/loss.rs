//! Physics as losses with hand-written gradients, for training, repair and guidance.
//!
//! Slice in, slice out: rotations, root translations and a change of shape go in; one number and
//! its derivatives to all of them come out. A motion streams through a short window of posed
//! frames: memory for work does not grow with its length. Everything is `f64`.
//!
//! * [`Penetration`] and [`Floating`]: the skin in the ground, and the lowest skin above it.
//! * [`Sliding`]: horizontal speed of sole points that ought to stand.
//! * [`SupportedBalance`]: the zero moment point inside the base of support.
//! * [`PressureBalance`]: the zero moment point at the centre of pressure, HUMOS's form.
//!
//! Who ought to stand when is not learnt from the motion under repair but told: by contact weights
//! of the source motion. A motion that may lift its feet to slide less would do so.

mod balance;
mod contact;
mod ground;
mod pressure;
pub mod reference;
mod shaped;
mod stream;
mod zero_moment;

pub use balance::SupportedBalance;
pub use contact::{Sliding, soft_contact, sole_contacts};
pub use ground::{Floating, Penetration};
pub use pressure::PressureBalance;
pub use shaped::{LossBody, SkinPoint};
pub use stream::{MotionGradient, MotionSlices, evaluate};

pub(crate) use shaped::ShapedBody;
pub(crate) use stream::Window;

/// One loss, as a mean over frames of a term that looks at a window around each frame.
pub trait FrameLoss {
    /// Frames that a term needs on either side.
    fn reach(&self) -> usize;

    /// Whether a frame without all its neighbours still has a term.
    fn at_ends(&self) -> bool {
        self.reach() == 0
    }

    /// The term of the frame in the middle of the window; adds `scale` times its gradient to the
    /// window's transforms and to the rest body.
    #[doc(hidden)]
    fn term(&self, window: &mut Window<'_>, scale: f64) -> f64;
}
