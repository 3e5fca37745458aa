//! Graphics processors against the processor: values, gradients, and steps of training.
//!
//! On machines without one, Mesa's software Vulkan (`mesa-vulkan-drivers`) is one. Where there is none
//! at all, tests say so and pass, unless `PHYSIQUE_REQUIRE_GPU` is set.

#![cfg(feature = "wgpu")]

mod golden;
mod loss;
mod support;
mod training;
