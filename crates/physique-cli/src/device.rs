//! Where networks run.

use clap::Args;
use physique_learn::DeviceChoice;

#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct DeviceArguments {
    /// Where networks run: `cpu`; `wgpu` for a graphics processor by Vulkan, Metal or Direct3D, or
    /// `cuda`, in programs built with that feature. With a number for one of several, such as
    /// `cuda:1`.
    #[arg(long, value_name = "NAME[:N]", default_value_t = DeviceChoice::Cpu)]
    pub(crate) device: DeviceChoice,
}
