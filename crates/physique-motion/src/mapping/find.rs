//! Finds the human joints of a foreign skeleton.

use physique_body::Joint;

use super::{
    human_joints::{Gathered, HumanJoints},
    name_table::NameTable,
    shape,
};
use crate::{Error, Skeleton};

/// How joints were found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FoundBy {
    /// By the names of a family of rigs.
    Names {
        /// The family's name.
        family: String,
    },
    /// By the shape of the tree.
    Shape,
    /// By a mapping file, which may leave the rest to names or shape.
    File {
        /// What found the joints that the file leaves out, if any.
        rest: Option<Box<FoundBy>>,
    },
}

/// Human joints and how they were found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// The joints.
    pub joints: HumanJoints,
    /// How they were found.
    pub by: FoundBy,
}

/// The human joints of a skeleton: by the family of names that covers most of them, otherwise by
/// the shape of the tree (then left and right are not told apart yet). `None` for a skeleton that
/// has no two legs and two arms.
pub fn find_joints(skeleton: &Skeleton) -> Option<Found> {
    let by_name = NameTable::families().iter().filter_map(|family| {
        let gathered = family.gather(skeleton);
        let count = gathered.count();
        let joints = gathered.finish()?;
        let found = Found {
            joints,
            by: FoundBy::Names {
                family: family.name().to_owned(),
            },
        };
        found
            .joints
            .problem(skeleton)
            .is_none()
            .then_some((count, found))
    });
    // The first of equals: families are listed in alphabetical order.
    let best = by_name.reduce(|best, next| if next.0 > best.0 { next } else { best });
    best.map(|(_, found)| found).or_else(|| {
        let joints = shape::find(skeleton)?;
        Some(Found {
            joints,
            by: FoundBy::Shape,
        })
    })
}

/// As [`find_joints`], with a mapping file's entries over what is found.
///
/// # Errors
/// [`Error::NotHuman`] with what is missing or wrong.
pub(super) fn find_joints_with(
    skeleton: &Skeleton,
    file: Option<&NameTable>,
) -> Result<Found, Error> {
    let found = find_joints(skeleton);
    let Some(file) = file else {
        return found.ok_or_else(|| Error::NotHuman {
            problem: "neither a known family of joint names nor two legs, two arms and a spine \
                      between them were found; a mapping file can name the joints"
                .into(),
        });
    };
    let unknown = file.unknown_names(skeleton);
    if !unknown.is_empty() {
        let problem = format!(
            "the mapping file names joints it lacks: {}",
            unknown.join(", ")
        );
        return Err(Error::NotHuman { problem });
    }
    let rest = found.as_ref().map(|found| Box::new(found.by.clone()));
    let under = found.map_or_else(Gathered::default, |found| found.joints.into());
    let gathered = file.over(under, skeleton);
    let missing: Vec<&str> = gathered.missing().into_iter().map(Joint::name).collect();
    let joints = gathered.finish().ok_or_else(|| Error::NotHuman {
        problem: format!("the mapping file must name {}", missing.join(", ")),
    })?;
    match joints.problem(skeleton) {
        Some(problem) => Err(Error::NotHuman {
            problem: format!("with the mapping file, {problem}"),
        }),
        None => Ok(Found {
            joints,
            by: FoundBy::File { rest },
        }),
    }
}
