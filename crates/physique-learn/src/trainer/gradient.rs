//! Parameters and their gradients by name.

use std::collections::BTreeMap;

use burn::module::{Module, ModuleMapper, ModuleVisitor, Param};
use burn::tensor::{Device, Gradients, Tensor};

/// Gradients of a network's parameters, flat, by the parameters' paths.
pub(super) struct NamedGradients(pub(super) BTreeMap<String, Tensor<1>>);

impl NamedGradients {
    /// Takes the gradients of a network's parameters; a parameter that the loss does not depend on
    /// has none.
    pub(super) fn of(network: &impl Module, gradients: Gradients) -> Self {
        let mut visitor = Collector {
            path: Vec::new(),
            gradients,
            found: BTreeMap::new(),
        };
        network.visit(&mut visitor);
        Self(visitor.found)
    }

    /// The sum of all squares, as a tensor.
    pub(super) fn squares(&self) -> Option<Tensor<1>> {
        let squares = self
            .0
            .values()
            .map(|gradient| gradient.clone().square().sum());
        squares.reduce(|sum, squares| sum + squares)
    }

    /// The same on another device, outside of any graph.
    pub(super) fn on_device(self, device: &Device) -> Self {
        let moved = self.0.into_iter();
        Self(
            moved
                .map(|(name, by)| (name, by.to_device(device)))
                .collect(),
        )
    }

    /// The sum with other gradients of the same network.
    pub(super) fn added(mut self, other: Self) -> Self {
        for (name, by) in other.0 {
            let sum = match self.0.remove(&name) {
                Some(sum) => sum + by,
                None => by,
            };
            self.0.insert(name, sum);
        }
        self
    }

    /// All gradients times a factor.
    pub(super) fn scaled(self, factor: f64) -> Self {
        let scaled = self.0.into_iter();
        Self(scaled.map(|(name, by)| (name, by * factor)).collect())
    }
}

struct Collector {
    path: Vec<String>,
    gradients: Gradients,
    found: BTreeMap<String, Tensor<1>>,
}

impl ModuleVisitor for Collector {
    fn enter_module(&mut self, name: &str, _kind: &str) {
        self.path.push(name.into());
    }

    fn exit_module(&mut self, _name: &str, _kind: &str) {
        self.path.pop();
    }

    fn visit_float<const D: usize>(&mut self, parameter: &Param<Tensor<D>>) {
        if let Some(gradient) = parameter.val().grad_remove(&mut self.gradients) {
            let count = gradient.shape().num_elements();
            let name = self.path.join(".");
            self.found.insert(name, gradient.reshape([count]));
        }
    }
}

/// All parameters of a network, flat, by their paths.
pub(super) fn tensors_of(network: &impl Module) -> BTreeMap<String, Tensor<1>> {
    let mut visitor = Finder {
        path: Vec::new(),
        found: BTreeMap::new(),
    };
    network.visit(&mut visitor);
    visitor.found
}

struct Finder {
    path: Vec<String>,
    found: BTreeMap<String, Tensor<1>>,
}

impl ModuleVisitor for Finder {
    fn enter_module(&mut self, name: &str, _kind: &str) {
        self.path.push(name.into());
    }

    fn exit_module(&mut self, _name: &str, _kind: &str) {
        self.path.pop();
    }

    fn visit_float<const D: usize>(&mut self, parameter: &Param<Tensor<D>>) {
        let parameter = parameter.val();
        let count = parameter.shape().num_elements();
        self.found
            .insert(self.path.join("."), parameter.reshape([count]));
    }
}

/// The network with each parameter changed: `change` is given its path and its numbers, flat and
/// outside of any graph.
pub(super) fn update<M: Module>(network: M, change: impl FnMut(&str, Tensor<1>) -> Tensor<1>) -> M {
    network.map(&mut Updater {
        path: Vec::new(),
        change,
    })
}

struct Updater<F> {
    path: Vec<String>,
    change: F,
}

impl<F: FnMut(&str, Tensor<1>) -> Tensor<1>> ModuleMapper for Updater<F> {
    fn enter_module(&mut self, name: &str, _kind: &str) {
        self.path.push(name.into());
    }

    fn exit_module(&mut self, _name: &str, _kind: &str) {
        self.path.pop();
    }

    fn map_float<const D: usize>(&mut self, parameter: Param<Tensor<D>>) -> Param<Tensor<D>> {
        let path = self.path.join(".");
        parameter.map(|old| {
            let (shape, differentiated, trained) =
                (old.dims(), old.is_autodiff(), old.is_require_grad());
            let count = shape.iter().product::<usize>();
            let new = (self.change)(&path, old.inner().reshape([count]));
            let new: Tensor<D> = new.reshape(shape);
            let new = if differentiated { new.autodiff() } else { new };
            new.set_require_grad(trained)
        })
    }
}
