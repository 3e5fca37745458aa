//! Spheres in place of a body: a *sphere proxy* is regressed from body shape and skinned to the 22
//! joints, and the *self-intersection loss* penalises spheres that pass through each other.
//!
//! After "Self-intersection-aware motion generation" (BMVC 2025, arXiv 2605.26744).
