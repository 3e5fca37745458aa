//! `physique proxy`: spheres in place of a body.

pub(crate) mod arguments;
mod evaluate;
mod fit;
mod pairs;
mod picture;

use std::path::Path;

use anyhow::Result;
use physique::proxy::SphereProxy;
use physique::proxy::files::{ProxyLimits, read_proxy, read_published};
use physique::proxy::open_proxy::open_proxy_with;

use crate::exit::Exit;
use arguments::{ProxyChoice, ProxyVerb};

pub(crate) fn run(verb: &ProxyVerb) -> Result<Exit> {
    match verb {
        ProxyVerb::Fit(arguments) => fit::run(arguments),
        ProxyVerb::Pairs(arguments) => pairs::run(arguments),
        ProxyVerb::Evaluate(arguments) => evaluate::run(arguments),
    }
}

impl ProxyChoice {
    /// The proxy that is asked for, and what to call it.
    pub(crate) fn load(&self) -> Result<(String, SphereProxy)> {
        let Some(path) = &self.proxy else {
            let name = format!("open body, {} spheres", self.spheres);
            return Ok((name, SphereProxy::clone(&*open_proxy_with(self.spheres)?)));
        };
        Ok((path.display().to_string(), read(path)?))
    }
}

/// A file of ours, or a folder in the published layout.
fn read(path: &Path) -> Result<SphereProxy> {
    let limits = ProxyLimits::default();
    Ok(if path.is_dir() {
        read_published(path, &limits)?
    } else {
        read_proxy(path, &limits)?
    })
}
