//! Names of protocols, groups and floors as values of flags.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use physique::{Floor, Group, Protocol};

/// A protocol, or all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ProtocolName {
    One(Protocol),
    All,
}

impl ProtocolName {
    /// The protocols named, each once, in the order of reports.
    pub(crate) fn named(names: &[Self]) -> Vec<Protocol> {
        let wanted = |protocol| names.contains(&Self::All) || names.contains(&Self::One(protocol));
        Protocol::ALL.into_iter().filter(|&p| wanted(p)).collect()
    }
}

impl ValueEnum for ProtocolName {
    fn value_variants<'a>() -> &'a [Self] {
        const NAMES: [ProtocolName; Protocol::ALL.len() + 1] = {
            let mut names = [ProtocolName::All; Protocol::ALL.len() + 1];
            let mut index = 0;
            while index < Protocol::ALL.len() {
                names[index] = ProtocolName::One(Protocol::ALL[index]);
                index += 1;
            }
            names
        };
        &NAMES
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self {
            Self::All => PossibleValue::new("all").help("all of them"),
            Self::One(protocol) => {
                let about = protocol.about();
                let rate = protocol.frame_rate();
                let rate = rate.map_or(String::new(), |fps| format!(", at {fps:.0} fps"));
                let help = format!("{}{rate} [{}]", about.measures, about.source);
                PossibleValue::new(protocol.name()).help(help)
            }
        })
    }
}

/// A group of Physique's own measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct GroupName(pub(crate) Group);

impl ValueEnum for GroupName {
    fn value_variants<'a>() -> &'a [Self] {
        const NAMES: [GroupName; Group::ALL.len()] = {
            let mut names = [GroupName(Group::ALL[0]); Group::ALL.len()];
            let mut index = 0;
            while index < Group::ALL.len() {
                names[index] = GroupName(Group::ALL[index]);
                index += 1;
            }
            names
        };
        &NAMES
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        let name = PossibleValue::new(self.0.name());
        Some(match self.0 {
            Group::SelfIntersection => name.alias("self"),
            _ => name,
        })
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum FloorName {
    /// At height 0: what is sunk or floats as a whole shows.
    Zero,
    /// At the lowest skin of the clip: nothing can sink.
    Lowest,
    /// Where slow soles stand.
    Estimated,
    /// 2 cm above the lowest skin: how HUMOS prepares its data.
    HumosSink,
}

impl From<FloorName> for Floor {
    fn from(name: FloorName) -> Self {
        match name {
            FloorName::Zero => Self::Zero,
            FloorName::Lowest => Self::Lowest,
            FloorName::Estimated => Self::Estimated,
            FloorName::HumosSink => Self::HumosSink,
        }
    }
}
