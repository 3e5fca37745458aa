//! `physique train mdm`.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use physique::body::{Body, Sex, open_body};
use physique_data::{Balance, DataLimits, Dataset, Order, SamplerOptions, Split};
use physique_files::write_file;
use physique_learn::checkpoint::Precision;
use physique_learn::data::CaptionedMotions;
use physique_learn::mdm::{
    ConditionKind, Mdm, MdmDescription, MdmFolder, MdmPlan, MdmTask, StartingNetwork, TextToMotion,
    WindowPlan,
};
use physique_learn::text::{CaptionCentre, Embeddings, KnownCaptions, PromptEncoder};
use physique_learn::trainer::{StepReport, Trainer};
use physique_learn::{Device, DeviceChoice};
use physique_text::TextEncoder;

use super::arguments::MdmArguments;
use super::watch::Watch;
use super::{plan, samples, start};
use crate::exit::Exit;
use crate::text_encoder;

/// Captions that are kept with a network, at most: enough to know what it was told.
const KEPT_CAPTIONS: usize = 1024;

pub(crate) fn run(arguments: &MdmArguments) -> Result<Exit> {
    let kept = plan::kept(&arguments.output)?;
    let start = start::open(arguments, kept.as_ref())?;
    let mut plan = plan::plan(arguments, kept, start.as_ref())?;
    let dataset = Dataset::open(&arguments.data, &DataLimits::default())?;
    let encoder = text_encoder::named(&arguments.text)?;
    plan.network.columns = dataset.skeleton().feature_count();
    plan.network.condition = match &encoder {
        None => ConditionKind::Unconditioned,
        Some(encoder) if encoder.is_by_token() => ConditionKind::Tokens {
            width: encoder.width(),
        },
        Some(encoder) => ConditionKind::Sentence {
            width: encoder.width(),
        },
    };
    if arguments.print_plan {
        println!("{}", serde_json::to_string_pretty(&plan)?);
        return Ok(Exit::Done);
    }
    // Before captions are read, which takes a while.
    let devices = open_devices(&arguments.device)?;
    if let Some(start) = &start {
        start::check(start, &plan, encoder.as_deref(), &dataset)?;
        start::keep_captions(start, &arguments.output)?;
    }
    plan::keep(&arguments.output, &plan)?;
    let centre = start::kept_centre(&arguments.output)?;
    let told = encoder
        .map(|encoder| Told::new(encoder, &dataset, centre))
        .transpose()?;
    let (told, start) = (told.as_ref(), start.as_ref());
    train(arguments, &plan, &dataset, told, start, &devices)?;
    println!("{}", arguments.output.join("model").display());
    Ok(Exit::Done)
}

/// What the network is told.
struct Told {
    prompts: PromptEncoder,
    known: KnownCaptions,
}

impl Told {
    /// `centre` is that of the network which the run starts from.
    fn new(
        encoder: Box<dyn TextEncoder>,
        dataset: &Dataset,
        centre: Option<CaptionCentre>,
    ) -> Result<Self> {
        let (training, held_out) = wordings(dataset);
        // CLIP and DistilBERT are read as published.
        let centre = match encoder.name() == "all-MiniLM-L6-v2" {
            true if centre.is_some() => centre,
            true => {
                eprintln!("note: reading the captions");
                let captions = spread(&training, KEPT_CAPTIONS);
                Some(CaptionCentre::of(&Embeddings::from(
                    &encoder.encode(&captions),
                ))?)
            }
            false => None,
        };
        let prompts = PromptEncoder::new(encoder, centre)?;
        let known = KnownCaptions::new(
            &prompts,
            &spread(&training, KEPT_CAPTIONS),
            &spread(&held_out, KEPT_CAPTIONS),
        )?;
        Ok(Self { prompts, known })
    }
}

/// Captions that training clips are described by, and those that are held out.
fn wordings(dataset: &Dataset) -> (Vec<&str>, Vec<&str>) {
    let index = dataset.index();
    let clips = dataset.clips_of(Split::Train);
    let mut sets: Vec<usize> = clips.map(|clip| index.clips[clip].captions).collect();
    sets.sort_unstable();
    sets.dedup();
    let texts = |of: fn(&physique_data::CaptionSet) -> &Vec<usize>| {
        let captions = sets.iter().flat_map(|&set| of(&index.caption_sets[set]));
        let mut captions: Vec<usize> = captions.copied().collect();
        captions.sort_unstable();
        captions.dedup();
        let texts = captions.into_iter();
        texts
            .map(|caption| index.captions[caption].text.as_str())
            .collect()
    };
    (texts(|set| &set.training), texts(|set| &set.held_out))
}

/// Evenly spread items, `most` of them at most.
fn spread<'a>(items: &[&'a str], most: usize) -> Vec<&'a str> {
    let count = items.len().min(most);
    (0..count)
        .map(|index| items[index * items.len() / count])
        .collect()
}

fn order(windows: &WindowPlan) -> Result<Order> {
    match &windows.balance_by {
        Some(label) => Ok(Order::BalancedBy(Balance {
            label: label.clone(),
            favoured: windows.favour.clone(),
        })),
        None => {
            ensure!(
                windows.favour.is_empty(),
                "The plan has windows.favour without windows.balance_by: expected the label whose values it favours."
            );
            Ok(Order::Passes)
        }
    }
}

/// Devices that differentiate.
fn open_devices(choices: &[DeviceChoice]) -> Result<Vec<Device>> {
    let devices = choices.iter().map(|choice| Ok(choice.open()?.autodiff()));
    devices.collect()
}

fn train(
    arguments: &MdmArguments,
    plan: &MdmPlan,
    dataset: &Dataset,
    told: Option<&Told>,
    start: Option<&StartingNetwork>,
    devices: &[Device],
) -> Result<()> {
    let frame_rate = dataset.frame_rate().per_second();
    let longest = plan.windows.longest_seconds;
    let longest = longest.map(|seconds| (seconds * frame_rate).round().max(1.0) as usize);
    let options = SamplerOptions {
        order: order(&plan.windows)?,
        longest,
        ..SamplerOptions::default()
    };
    let prompts = told.map(|told| &told.prompts);
    let source = CaptionedMotions::new(dataset, options, prompts)?;
    let task = MdmTask::new(source, dataset.statistics(), plan.training.clone())?;
    let home = devices.first().context("expected a device, found none")?;
    let network = match start {
        Some(start) => start.network(&plan.network, home)?,
        None => Mdm::new(&plan.network, plan.run.seed, home)?,
    };
    let mut trainer = Trainer::open(task, network, plan.run.clone(), &arguments.output)?;
    if devices.len() > 1 {
        trainer = trainer.on_devices(devices.to_vec());
    }
    if start.is_some() {
        // From here on the run needs the network that it started from no more.
        trainer.save()?;
    }

    let body = Body::mean(open_body()?, Sex::Neutral)?;
    let longest = longest.map_or(dataset.index().longest_window, |rows| {
        rows.min(dataset.index().longest_window)
    });
    let mut watch = Watch::new(trainer.steps_done(), plan.run.steps);
    loop {
        // Stops at every checkpoint, which is written before `run` comes back.
        trainer.run(|report: &StepReport| {
            watch.step(report);
            !report.step.is_multiple_of(plan.run.save_every)
        })?;
        let done = trainer.steps_done();
        let folder = MdmFolder {
            network: trainer.network(),
            statistics: dataset.statistics().clone(),
            captions: told.map(|told| told.known.clone()),
            description: MdmDescription {
                frame_rate,
                longest_frames: Some(longest),
                diffusion_steps: plan.training.diffusion_steps,
                signal: plan.training.signal,
                text_encoder: prompts.map_or_else(String::new, |p| p.encoder().name().to_owned()),
                notes: notes(dataset, plan, done),
            },
        };
        write(&arguments.output.join("model"), &folder, plan)?;
        let last = done >= plan.run.steps;
        let every = arguments.samples.sample_every * plan.run.save_every;
        if every > 0 && (last || done.is_multiple_of(every)) {
            let encoder = text_encoder::named(&arguments.text)?;
            let network = TextToMotion::new(folder, encoder)?;
            let prompts = sampled_prompts(arguments, told);
            let folder = arguments.output.join(format!("samples/step-{done:09}"));
            samples::draw(&network, &prompts, longest, &body, &folder)?;
        }
        if last {
            break;
        }
    }
    watch.finish();
    Ok(())
}

/// Prompts of the flags, or four training captions.
fn sampled_prompts(arguments: &MdmArguments, told: Option<&Told>) -> Vec<String> {
    match (&arguments.samples.prompts, told) {
        (prompts, _) if !prompts.is_empty() => prompts.clone(),
        (_, None) => vec![String::new(); 4],
        (_, Some(told)) => {
            let texts: Vec<&str> = told.known.texts().iter().map(String::as_str).collect();
            spread(&texts, 4).into_iter().map(str::to_owned).collect()
        }
    }
}

fn notes(dataset: &Dataset, plan: &MdmPlan, done: u64) -> BTreeMap<String, String> {
    let index = dataset.index();
    let hours: f64 = index
        .report
        .splits
        .get(&Split::Train)
        .map_or(0.0, |amount| amount.hours);
    let origin = plan.started_from.as_ref();
    let origin = origin.map(|origin| format!("{} ({})", origin.path, origin.sha256));
    let origin = origin.map(|origin| ("started_from", origin));
    let notes = [
        ("data", index.name.clone()),
        ("licence", index.licence.clone()),
        ("attribution", index.attribution.clone()),
        ("hours", format!("{hours:.2}")),
        ("steps", done.to_string()),
        ("batch", plan.training.batch.to_string()),
        ("seed", plan.run.seed.to_string()),
        ("physique", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    let notes = notes.into_iter().chain(origin);
    notes
        .map(|(name, value)| (name.to_owned(), value))
        .collect()
}

/// Writes the network with a card.
fn write(path: &Path, folder: &MdmFolder, plan: &MdmPlan) -> Result<()> {
    folder.write(path, Precision::Single)?;
    let notes = folder.description.notes.iter();
    let notes: String = notes
        .map(|(name, value)| format!("* {name}: {value}\n"))
        .collect();
    let card = format!(
        "# A motion diffusion model\n\nTrained by `physique train mdm`. What it may be used for depends on the licence of its data.\n\n{notes}\n## Plan\n\n```json\n{}\n```\n",
        serde_json::to_string_pretty(plan)?
    );
    write_file(&path.join("CARD.md"), card.as_bytes()).with_context(|| path.display().to_string())
}
