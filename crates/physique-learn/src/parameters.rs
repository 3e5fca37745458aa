//! A network's numbers by name, on their way between files and networks.

use std::collections::BTreeMap;

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::tensor::{Tensor, TensorData};

use crate::Error;
use crate::error::Names;

/// Arrays of numbers by name, as a file or a network has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parameters {
    /// Where they are from, for errors.
    pub source: String,
    /// By name.
    pub arrays: BTreeMap<String, ParameterArray>,
}

/// Numbers in a shape, the last index fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterArray {
    /// Length of every dimension.
    pub shape: Vec<usize>,
    /// As many as the shape asks for.
    pub values: Vec<f32>,
}

/// How a network's fields are called in published files: pairs of our path and theirs, for the
/// path itself and all that begins with it, or, where they have a `*` for a number, for the whole path.
/// What no pair is for keeps its name.
pub type NameTable = &'static [(&'static str, &'static str)];

/// The published name of one of our paths.
fn published(path: &str, table: NameTable) -> String {
    let pairs = table.iter().filter_map(|(ours, theirs)| {
        if let Some((before, behind)) = ours.split_once('*') {
            let number = path.strip_prefix(before)?.strip_suffix(behind)?;
            let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
            return is_number.then(|| theirs.replace('*', number));
        }
        let rest = path.strip_prefix(ours)?;
        let whole = rest.is_empty() || rest.starts_with('.');
        whole.then(|| format!("{theirs}{rest}"))
    });
    pairs.into_iter().next().unwrap_or_else(|| path.to_owned())
}

impl Parameters {
    /// All parameters of a network, under their published names.
    ///
    /// # Errors
    /// [`Error::Device`] where the numbers cannot be fetched.
    pub fn of(network: &impl Module, source: &str, table: NameTable) -> Result<Self, Error> {
        let mut reader = Reader {
            path: Vec::new(),
            table,
            arrays: BTreeMap::new(),
            problem: None,
        };
        network.visit(&mut reader);
        match reader.problem {
            Some(problem) => Err(problem),
            None => Ok(Self {
                source: source.into(),
                arrays: reader.arrays,
            }),
        }
    }

    /// Numbers of all arrays.
    pub fn count(&self) -> usize {
        self.arrays.values().map(|array| array.values.len()).sum()
    }

    /// Leaves out arrays whose names begin with one of `prefixes`.
    #[must_use]
    pub fn without(mut self, prefixes: &[&str]) -> Self {
        self.arrays
            .retain(|name, _| !prefixes.iter().any(|prefix| name.starts_with(prefix)));
        self
    }

    /// Only the arrays whose names begin with `prefix`, which is taken off.
    #[must_use]
    pub fn below(self, prefix: &str) -> Self {
        let arrays = self.arrays.into_iter().filter_map(|(name, array)| {
            let rest = name.strip_prefix(prefix)?.to_owned();
            Some((rest, array))
        });
        Self {
            source: self.source,
            arrays: arrays.collect(),
        }
    }

    /// The network with these numbers, strictly: each of its parameters must be here under its
    /// published name and in its shape, and nothing else.
    ///
    /// # Errors
    /// [`Error::Parameters`] with all names that are missing and all that are not known;
    /// [`Error::ParameterShape`] for the first of another shape.
    pub fn load<M: Module>(
        self,
        module: M,
        network: &'static str,
        table: NameTable,
    ) -> Result<M, Error> {
        let mut writer = Writer {
            path: Vec::new(),
            table,
            source: self.source,
            arrays: self.arrays,
            missing: Vec::new(),
            problem: None,
        };
        let module = module.map(&mut writer);
        if !writer.missing.is_empty() || !writer.arrays.is_empty() {
            return Err(Error::Parameters {
                source_name: writer.source,
                network,
                missing: Names(writer.missing),
                surplus: Names(writer.arrays.into_keys().collect()),
            });
        }
        match writer.problem {
            Some(problem) => Err(problem),
            None => Ok(module),
        }
    }
}

/// Collects a network's numbers.
struct Reader {
    path: Vec<String>,
    table: NameTable,
    arrays: BTreeMap<String, ParameterArray>,
    problem: Option<Error>,
}

impl ModuleVisitor for Reader {
    fn enter_module(&mut self, name: &str, _kind: &str) {
        self.path.push(name.into());
    }

    fn exit_module(&mut self, _name: &str, _kind: &str) {
        self.path.pop();
    }

    fn visit_float<const D: usize>(&mut self, parameter: &Param<Tensor<D>>) {
        let tensor = parameter.val();
        let shape = tensor.dims().to_vec();
        match crate::tensors::numbers(tensor) {
            Ok(values) => {
                let name = published(&self.path.join("."), self.table);
                self.arrays.insert(name, ParameterArray { shape, values });
            }
            Err(problem) => self.problem = Some(problem),
        }
    }
}

/// Puts numbers into a network.
struct Writer {
    path: Vec<String>,
    table: NameTable,
    source: String,
    arrays: BTreeMap<String, ParameterArray>,
    missing: Vec<String>,
    problem: Option<Error>,
}

impl ModuleMapper for Writer {
    fn enter_module(&mut self, name: &str, _kind: &str) {
        self.path.push(name.into());
    }

    fn exit_module(&mut self, _name: &str, _kind: &str) {
        self.path.pop();
    }

    fn map_float<const D: usize>(&mut self, parameter: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let name = published(&self.path.join("."), self.table);
        let Some(array) = self.arrays.remove(&name) else {
            self.missing.push(name);
            return parameter;
        };
        let expected = parameter.val().dims();
        if array.shape != expected {
            self.problem.get_or_insert(Error::ParameterShape {
                source_name: self.source.clone(),
                name,
                expected: expected.to_vec(),
                found: array.shape,
            });
            return parameter;
        }
        parameter.map(|old| {
            let trained = old.is_require_grad();
            let data = TensorData::new(array.values, expected);
            Tensor::from_data(data, &old.device()).set_require_grad(trained)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::published;

    #[test]
    fn whole_parts_of_a_path_are_renamed() {
        let table = &[("pose", "input.poseEmbedding"), ("encoder", "seqEncoder")];
        assert_eq!(
            published("pose.weight", table),
            "input.poseEmbedding.weight"
        );
        assert_eq!(published("pose", table), "input.poseEmbedding");
        assert_eq!(published("pose_final.bias", table), "pose_final.bias");
        assert_eq!(
            published("encoder.layers.0.w", table),
            "seqEncoder.layers.0.w"
        );
        let table = &[("gru.layers.*.bias", "gru.bias_l*")];
        assert_eq!(published("gru.layers.12.bias", table), "gru.bias_l12");
        for other in [
            "gru.layers.1.2.bias",
            "gru.layers..bias",
            "gru.layers.1.bias.x",
        ] {
            assert_eq!(published(other, table), other);
        }
    }
}
