//! Regressors against published outputs, an f64 reference, and differences.

use physique_files::npz::{Archive, ArrayLimits};
use physique_proxy::regressor::{Activations, Gradient, NetworkLayout};
use physique_proxy::{Error, JointRegressor, SphereRegressor};

const BETAS: usize = 10;
const WIDTH: usize = 32;
const SPHERES: usize = 12;

/// The deterministic numbers of the golden files, in [-1, 1).
fn golden_number(stream: u64, index: u64) -> f64 {
    let mut z = (stream + 1)
        .wrapping_mul(0x9E37_79B9_7F4A_7C15)
        .wrapping_add(index.wrapping_mul(0xD1B5_4A32_D192_ED03));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^= z >> 31;
    (z >> 40) as f64 / (1_u64 << 23) as f64 - 1.0
}

/// Weights of the golden files: numbers of the arrays sorted by name.
fn golden_parameters(layout: &NetworkLayout) -> Vec<f32> {
    let mut sorted: Vec<_> = layout.parameters().iter().collect();
    sorted.sort_by(|a, b| a.name.cmp(&b.name));
    let mut parameters = vec![0.0; layout.parameter_count()];
    for (stream, parameter) in sorted.into_iter().enumerate() {
        let scale = match parameter.shape.as_slice() {
            [_] => 0.1,
            [_, inner @ ..] => (3.0 / inner.iter().product::<usize>() as f64).sqrt(),
            [] => 1.0,
        };
        for (index, value) in parameters[parameter.range.clone()].iter_mut().enumerate() {
            *value = (golden_number(stream as u64, index as u64) * scale) as f32;
        }
    }
    parameters
}

fn sphere_regressor() -> SphereRegressor {
    let layout = SphereRegressor::layout(BETAS, WIDTH, SPHERES).expect("possible");
    let parameters = golden_parameters(&layout);
    SphereRegressor::new(layout, parameters).expect("finite")
}

fn joint_regressor() -> JointRegressor {
    let layout = JointRegressor::layout(BETAS, WIDTH).expect("possible");
    let parameters = golden_parameters(&layout);
    JointRegressor::new(layout, parameters).expect("finite")
}

#[test]
fn published_outputs() {
    let bytes = include_bytes!("fixtures/sphere_small.npz").to_vec();
    let mut archive = Archive::open(bytes, ArrayLimits::default()).expect("a sound archive");
    let mut array = |key: &str| archive.array(key).expect(key).to_f32().expect(key);
    let (betas, spheres, joints) = (array("beta"), array("sphere_out"), array("joint_out"));
    for (body, betas) in betas.chunks(BETAS).enumerate() {
        let found = sphere_regressor().spheres(betas).expect("finite");
        for sphere in 0..SPHERES {
            let start = 4 * (body * SPHERES + sphere);
            let expected = &spheres[start..start + 4];
            assert!((found.radii[sphere].ln() - expected[0]).abs() < 1e-5);
            let centre = found.centres[sphere].to_array();
            for (found, expected) in centre.iter().zip(&expected[1..]) {
                assert!((found - expected).abs() < 1e-5);
            }
        }
        let found = joint_regressor().joints(betas).expect("finite");
        let found = found.iter().flat_map(|joint| joint.to_array());
        for (found, expected) in found.zip(&joints[66 * body..66 * (body + 1)]) {
            assert!((found - expected).abs() < 1e-5);
        }
    }
}

#[test]
fn the_papers_size() {
    let spheres = SphereRegressor::layout(10, SphereRegressor::WIDTH, 192).expect("possible");
    assert_eq!(spheres.parameter_count(), 2_237_164);
    let joints = JointRegressor::layout(10, JointRegressor::WIDTH).expect("possible");
    assert_eq!(joints.parameter_count(), 302_146);
    let named: Vec<_> = spheres
        .parameters()
        .iter()
        .map(|parameter| (parameter.name.as_str(), parameter.shape.as_slice()))
        .collect();
    assert_eq!(named[0], ("net1.0.weight_v", &[512, 10][..]));
    assert!(named.contains(&("net1.6.weight_g", &[502, 1][..])));
    assert!(named.contains(&("net2.8.weight", &[768, 512][..])));
    assert_eq!(named.len(), 8 * 3 + 2);
}

/// The sphere regressor layer by layer in f64, with its parameters by name.
fn reference(layout: &NetworkLayout, parameters: &[f64], betas: &[f64]) -> Vec<f64> {
    let array = |name: String| {
        let found = layout.parameters().iter().find(|p| p.name == name);
        found.map(|found| &parameters[found.range.clone()])
    };
    let mut values = betas.to_vec();
    for (index, name) in [
        "net1.0", "net1.2", "net1.4", "net1.6", "net2.0", "net2.2", "net2.4", "net2.6", "net2.8",
    ]
    .into_iter()
    .enumerate()
    {
        let bias = array(format!("{name}.bias")).expect("a bias");
        let gain = array(format!("{name}.weight_g"));
        let rows = array(format!("{name}.weight_v")).or(array(format!("{name}.weight")));
        let rows = rows.expect("weights").chunks(values.len());
        let mut next: Vec<f64> = rows
            .enumerate()
            .map(|(output, row)| {
                let product: f64 = row.iter().zip(&values).map(|(w, x)| w * x).sum();
                let length = row.iter().map(|w| w * w).sum::<f64>().sqrt();
                product * gain.map_or(1.0, |gain| gain[output] / length) + bias[output]
            })
            .collect();
        if index < 8 {
            next.iter_mut().for_each(|value| *value = value.max(0.0));
        }
        if index == 3 {
            next.extend_from_slice(betas);
        }
        values = next;
    }
    values
}

/// A batch of betas, `[betas][batch]`, and made-up slopes of the outputs.
fn batch(size: usize, outputs: usize) -> (Vec<f32>, Vec<f32>) {
    let numbers = |stream: u64, count: usize| {
        let numbers = (0..count as u64).map(|index| golden_number(stream, index) as f32);
        numbers.collect::<Vec<_>>()
    };
    (numbers(500, BETAS * size), numbers(501, outputs * size))
}

#[test]
fn a_batch_and_its_gradient_equal_the_reference() {
    const SIZE: usize = 5;
    let regressor = sphere_regressor();
    let network = regressor.network();
    let layout = network.layout();
    let (betas, slopes) = batch(SIZE, 4 * SPHERES);
    let mut activations = Activations::default();
    network.forward(&betas, SIZE, &mut activations);
    let mut gradient = Gradient::default();
    network.backward(&activations, &slopes, &mut gradient);

    let exact: Vec<f64> = network.parameters().iter().map(|&p| p.into()).collect();
    let betas: Vec<f64> = betas.into_iter().map(f64::from).collect();
    let loss = |parameters: &[f64], betas: &[f64]| -> f64 {
        let of_body = |body: usize| -> f64 {
            let one: Vec<f64> = (0..BETAS).map(|beta| betas[beta * SIZE + body]).collect();
            let outputs = reference(layout, parameters, &one);
            let weighted = outputs.iter().enumerate();
            weighted
                .map(|(output, value)| value * f64::from(slopes[output * SIZE + body]))
                .sum()
        };
        (0..SIZE).map(of_body).sum()
    };
    let found: f64 = (activations.outputs().iter().zip(&slopes))
        .map(|(value, slope)| f64::from(value * slope))
        .sum();
    assert!((found - loss(&exact, &betas)).abs() < 1e-4);

    let slope = |change: &dyn Fn(f64) -> f64| (change(1e-6) - change(-1e-6)) / 2e-6;
    for parameter in layout.parameters() {
        let places = parameter
            .range
            .clone()
            .step_by(parameter.range.len().div_ceil(7));
        for place in places {
            let expected = slope(&|step| {
                let mut moved = exact.clone();
                moved[place] += step;
                loss(&moved, &betas)
            });
            let found = f64::from(gradient.parameters[place]);
            let name = &parameter.name;
            assert!(
                (found - expected).abs() < 1e-4,
                "{name}: {found} for {expected}"
            );
        }
    }
    for place in 0..betas.len() {
        let expected = slope(&|step| {
            let mut moved = betas.clone();
            moved[place] += step;
            loss(&exact, &moved)
        });
        assert!((f64::from(gradient.inputs[place]) - expected).abs() < 1e-4);
    }
}

#[test]
fn shapes_follow_losses_of_spheres() {
    let regressor = sphere_regressor();
    let betas = [0.3, -0.5, 0.8, 0.1, -0.9, 0.4, 0.2];
    let spheres = regressor.spheres(&betas).expect("finite");
    // Loss: sum of x and z of all centres, and of all radii.
    let centre_slopes = vec![glam::Vec3::new(1.0, 0.0, 1.0); SPHERES];
    let found = regressor
        .betas_gradient(&betas, &centre_slopes, &[1.0; SPHERES])
        .expect("fits");
    assert_eq!(found.len(), betas.len());
    let loss = |spheres: &physique_proxy::RegressedSpheres| -> f64 {
        let centres = spheres.centres.iter().map(|c| f64::from(c.x + c.z));
        centres.sum::<f64>() + spheres.radii.iter().map(|&r| f64::from(r)).sum::<f64>()
    };
    let here = loss(&spheres);
    for (index, slope) in found.iter().enumerate() {
        let mut moved = betas;
        moved[index] += 1e-3;
        let difference = (loss(&regressor.spheres(&moved).expect("finite")) - here) / 1e-3;
        let tolerance = 0.02 * difference.abs() + 0.01;
        assert!(
            (f64::from(*slope) - difference).abs() < tolerance,
            "{slope} for {difference}"
        );
    }
    let wrong = regressor.betas_gradient(&betas, &centre_slopes, &[1.0]);
    assert!(matches!(
        wrong,
        Err(Error::Length {
            expected: SPHERES,
            found: 1,
            ..
        })
    ));
}

#[test]
fn bad_inputs_are_refused() {
    let regressor = sphere_regressor();
    assert!(matches!(
        regressor.spheres(&[0.0; 11]),
        Err(Error::Betas { available: 10, .. })
    ));
    assert!(matches!(
        regressor.spheres(&[f32::NAN]),
        Err(Error::Betas { .. })
    ));
    assert!(matches!(
        joint_regressor().joints(&[f32::INFINITY]),
        Err(Error::Betas { .. })
    ));
    for (betas, width, spheres) in [(0, 32, 1), (10, 10, 1), (10, 32, 0), (1, 1 << 40, 1)] {
        assert!(SphereRegressor::layout(betas, width, spheres).is_err());
    }
    assert!(JointRegressor::layout(0, 5).is_err());

    let layout = SphereRegressor::layout(2, 4, 1).expect("possible");
    let count = layout.parameter_count();
    let made = |parameters| SphereRegressor::new(layout.clone(), parameters);
    assert!(made(vec![1.0; count]).is_ok());
    assert!(matches!(
        made(vec![1.0; count - 1]),
        Err(Error::Regressor { .. })
    ));
    // A direction of length 0 points nowhere.
    assert!(matches!(
        made(vec![0.0; count]),
        Err(Error::Regressor { .. })
    ));
    let mut parameters = vec![1.0; count];
    parameters[count - 1] = f32::NAN;
    let error = made(parameters).expect_err("NaN").to_string();
    assert!(error.contains("net2.8.bias"), "{error}");
}
