//! Where networks run.

use std::fmt;
use std::str::FromStr;

use burn::tensor::Device;

use crate::Error;

/// The device that networks run on unless one says otherwise: the processor.
pub fn device() -> Device {
    Device::flex()
}

/// A device by its name: `cpu`, `wgpu`, `cuda`, and the latter two with a number, such as `cuda:1`.
///
/// Any name can be read; [`DeviceChoice::open`] tells those that this program was built without.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DeviceChoice {
    /// The processor.
    #[default]
    Cpu,
    /// A graphics processor by Vulkan, Metal or Direct3D: the one of this number, or the fastest.
    Wgpu(Option<usize>),
    /// NVIDIA's of this number, by CUDA.
    Cuda(usize),
}

impl DeviceChoice {
    /// The device. It does not differentiate; [`Device::autodiff`] does.
    ///
    /// # Errors
    /// [`Error::NoDevice`] where the program was built without it, or the machine lacks it.
    pub fn open(self) -> Result<Device, Error> {
        match self {
            Self::Cpu => Ok(device()),
            Self::Wgpu(number) => self.wgpu(number),
            Self::Cuda(number) => self.cuda(number),
        }
    }

    #[cfg(feature = "wgpu")]
    fn wgpu(self, number: Option<usize>) -> Result<Device, Error> {
        use burn::tensor::{DeviceKind, DeviceType};

        let found = Device::enumerate(DeviceType::Wgpu).into_vec();
        match number {
            None if !found.is_empty() => Ok(Device::wgpu(DeviceKind::DefaultDevice)),
            number => self.one_of(found, number.unwrap_or(0)),
        }
    }

    #[cfg(not(feature = "wgpu"))]
    fn wgpu(self, _number: Option<usize>) -> Result<Device, Error> {
        Err(self.not_built("wgpu"))
    }

    #[cfg(feature = "cuda")]
    fn cuda(self, number: usize) -> Result<Device, Error> {
        let found = Device::enumerate(burn::tensor::DeviceType::Cuda).into_vec();
        self.one_of(found, number)
    }

    #[cfg(not(feature = "cuda"))]
    fn cuda(self, _number: usize) -> Result<Device, Error> {
        Err(self.not_built("cuda"))
    }

    #[cfg(feature = "cubecl")]
    fn one_of(self, mut found: Vec<Device>, number: usize) -> Result<Device, Error> {
        if number < found.len() {
            return Ok(found.swap_remove(number));
        }
        let problem = match found.len() {
            0 => "this machine has none, or no driver for it".to_owned(),
            count => format!("expected a number below {count}, as many as were found"),
        };
        Err(Error::NoDevice {
            device: self.to_string(),
            problem,
        })
    }

    #[cfg(not(all(feature = "wgpu", feature = "cuda")))]
    fn not_built(self, feature: &str) -> Error {
        Error::NoDevice {
            device: self.to_string(),
            problem: format!(
                "this program was built without it; build it with `--features {feature}`"
            ),
        }
    }
}

impl fmt::Display for DeviceChoice {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cpu => formatter.write_str("cpu"),
            Self::Wgpu(None) => formatter.write_str("wgpu"),
            Self::Wgpu(Some(number)) => write!(formatter, "wgpu:{number}"),
            Self::Cuda(number) => write!(formatter, "cuda:{number}"),
        }
    }
}

impl FromStr for DeviceChoice {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let refuse = || {
            let expected = "cpu, wgpu, wgpu:NUMBER, cuda or cuda:NUMBER";
            Error::setting("device", expected, format!("`{}`", text.escape_debug()))
        };
        let (name, number) = match text.split_once(':') {
            None => (text, None),
            Some((name, number)) => (name, Some(number.parse().map_err(|_| refuse())?)),
        };
        match (name, number) {
            ("cpu", None) => Ok(Self::Cpu),
            ("wgpu", number) => Ok(Self::Wgpu(number)),
            ("cuda", number) => Ok(Self::Cuda(number.unwrap_or(0))),
            _ => Err(refuse()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::DeviceChoice;

    #[test]
    fn names_are_read_as_they_are_written() {
        for (name, choice) in [
            ("cpu", DeviceChoice::Cpu),
            ("wgpu", DeviceChoice::Wgpu(None)),
            ("wgpu:2", DeviceChoice::Wgpu(Some(2))),
            ("cuda:0", DeviceChoice::Cuda(0)),
        ] {
            assert_eq!(name.parse::<DeviceChoice>().expect(name), choice);
            assert_eq!(choice.to_string(), name);
        }
        let first: DeviceChoice = "cuda".parse().expect("the first");
        assert_eq!(first, DeviceChoice::Cuda(0));
        for wrong in ["", "gpu", "cpu:0", "cuda:", "wgpu:-1", "cuda:0:1", "CUDA"] {
            let told = wrong.parse::<DeviceChoice>().expect_err(wrong).to_string();
            assert!(told.contains("cpu, wgpu, wgpu:NUMBER"), "{told}");
        }
    }

    #[cfg(not(feature = "cuda"))]
    #[test]
    fn what_was_not_built_names_its_feature() {
        let told = DeviceChoice::Cuda(1).open().expect_err("not built");
        let told = told.to_string();
        assert!(told.starts_with("Device cuda:1: "), "{told}");
        assert!(told.contains("--features cuda"), "{told}");
    }

    #[cfg(feature = "wgpu")]
    #[test]
    fn devices_that_are_not_there_are_refused() {
        let told = DeviceChoice::Wgpu(Some(4096)).open().expect_err("so many");
        assert!(told.to_string().starts_with("Device wgpu:4096: "), "{told}");
    }
}
