//! Published networks that walk over frames, and those that plan.

use burn::tensor::{Bool, Device, Tensor, TensorData};
use physique_learn::checkpoint::CheckpointLimits;
use physique_learn::diffusion::{Method, Sampler, Schedule};
use physique_learn::layers::Dropout;
use physique_learn::mdm::{
    Architecture, Condition, GenerateRequest, Mdm, MdmConfig, MdmQuery, PUBLISHED_NAMES,
    PlannerConfig, generate, parameters_of, plan_motions, read_published,
};

use crate::support::{array, fixture};

/// Array of `expected_others.npz`.
fn other<const D: usize>(key: &str) -> Tensor<D> {
    array("expected_others.npz", key)
}

/// Largest difference from what PyTorch predicted for its three motions.
fn error_of_other(
    model: &Mdm,
    key: &str,
    condition: Condition,
    (lengths, context): (Option<&[usize]>, Option<Tensor<3>>),
) -> f32 {
    let query = MdmQuery {
        noisy: other("x"),
        steps: &[3, 41, 0],
        condition: &condition,
        conditioned: None,
        lengths,
        context,
    };
    let predicted = model.forward(query, &Dropout::none()).expect("it fits");
    (predicted - other::<3>(key))
        .abs()
        .max()
        .into_scalar::<f32>()
}

#[test]
fn recurrent_networks_are_read() {
    let limits = CheckpointLimits::default();
    let read = read_published(&fixture("gru/model.pt"), &limits, &Device::flex());
    let (model, _) = read.expect("sound");
    let config = model.config();
    assert_eq!(config.architecture, Architecture::GruOverBatch);
    assert_eq!([config.columns, config.width, config.layers], [6, 8, 2]);
    let text = || Condition::Text {
        tokens: other::<2>("text").unsqueeze_dim(1),
        padding: None,
    };
    // As published it walks over the batch.
    let error = error_of_other(&model, "gru_over_batch", text(), (None, None));
    assert!(error < 2e-6, "{error}");
    // The same numbers, over frames.
    let over_frames = MdmConfig {
        architecture: Architecture::Gru,
        ..config.clone()
    };
    let parameters = parameters_of(&model, "a test").expect("readable");
    let network = Mdm::new(&over_frames, 0, &Device::flex()).expect("possible");
    let network = parameters
        .load(network, "MDM", PUBLISHED_NAMES)
        .expect("the same names");
    let error = error_of_other(&network, "gru_over_frames", text(), (None, None));
    assert!(error < 2e-6, "{error}");
}

fn planner() -> Mdm {
    let limits = CheckpointLimits::default();
    let read = read_published(&fixture("planner/model.pt"), &limits, &Device::flex());
    let (model, arguments) = read.expect("sound");
    assert_eq!(arguments.diffusion_steps, 10);
    model
}

/// Vectors of tokens, of which the second caption has two.
fn tokens() -> Condition {
    let padding: Vec<bool> = (0..12)
        .map(|token| token / 4 == 1 && token % 4 >= 2)
        .collect();
    let padding = TensorData::new(padding, [3, 4]);
    Condition::Text {
        tokens: other("tokens"),
        padding: Some(Tensor::<2, Bool>::from_data(padding, &Device::flex())),
    }
}

#[test]
fn planners_go_on_from_clean_frames() {
    let model = planner();
    let expected = PlannerConfig {
        context: 3,
        prediction: 7,
    };
    assert_eq!(model.config().planner, Some(expected));
    let context = other::<3>("context");
    let lengths = Some(&[7, 5, 1][..]);
    let error = error_of_other(
        &model,
        "planned",
        tokens(),
        (lengths, Some(context.clone())),
    );
    assert!(error < 3e-6, "{error}");

    // Without frames to go on from, or with others than it was trained with.
    let condition = tokens();
    for (wrong, found) in [
        (None, "found none"),
        (Some(context.narrow(1, 0, 2)), "found [3, 2, 6]"),
    ] {
        let query = MdmQuery {
            noisy: other("x"),
            steps: &[3, 41, 0],
            condition: &condition,
            conditioned: None,
            lengths: None,
            context: wrong,
        };
        let told = model.forward(query, &Dropout::none()).expect_err("misfit");
        assert!(told.to_string().contains(found), "{told}");
    }
}

#[test]
fn plans_are_made_piece_by_piece() {
    let (model, condition, context) = (planner(), tokens(), other::<3>("context"));
    let schedule = Schedule::cosine(10).expect("in range");
    let sampler = Sampler::new(schedule, Method::Ancestral);
    let request = |lengths, context| GenerateRequest {
        condition: &condition,
        lengths,
        seeds: &[1, 2, 3],
        guidance: 7.5,
        edit: None,
        guides: &[],
        context,
    };
    let mut left = Vec::new();
    let lengths = [17, 7, 4];
    let planned = plan_motions(
        &model,
        &sampler,
        request(&lengths, None),
        &context,
        |steps| {
            left.push(steps);
        },
    );
    let planned = planned.expect("it fits");
    assert_eq!(left, (0..30).rev().collect::<Vec<_>>());
    let frames: Vec<usize> = planned.iter().map(|motion| motion.len() / 6).collect();
    assert_eq!(frames, lengths);

    // The first piece is that of the same seeds; the second depends on the first one's end.
    let first = generate(&model, &sampler, request(&[7; 3], Some(&context)), |_| ());
    let first = first.expect("it fits");
    assert_eq!(planned[0][..42], first[0]);
    assert_eq!(planned[1], first[1]);
    assert_eq!(planned[2], first[2][..24]);
    let elsewhere = context.clone() * -1.0;
    let other = plan_motions(
        &model,
        &sampler,
        request(&lengths, None),
        &elsewhere,
        |_| (),
    );
    assert_ne!(other.expect("it fits")[0][42..], planned[0][42..]);

    let told = |request, context: &Tensor<3>| {
        let planned = plan_motions(&model, &sampler, request, context, |_| ());
        planned.expect_err("misfit").to_string()
    };
    assert!(told(request(&lengths, Some(&context)), &context).contains("no edit and no context"));
    let short = context.clone().narrow(1, 0, 1);
    assert!(told(request(&lengths, None), &short).contains("expected [3, 3, 6]"));
    let limits = CheckpointLimits::default();
    let whole = read_published(&fixture("flat.pt"), &limits, &Device::flex());
    let whole = whole.expect("sound").0;
    let planned = plan_motions(&whole, &sampler, request(&lengths, None), &context, |_| ());
    let told = planned.expect_err("no planner").to_string();
    assert!(told.contains("one that makes whole motions"), "{told}");
}
