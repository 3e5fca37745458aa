//! A contact sheet of a motion on a body: what `physique view --png` draws.

use glam::Vec3;
use physique::body::{Body, Joint, PosedBody};
use physique::geometry::{SharedVertices, TrianglePairs, Triangles};
use physique::motion::Motion;
use physique::self_intersection::{FrameIntersections, is_crease};

use crate::{
    Chart, Colour, Colours, ContactSheet, Frame, Image, View, ViewError, body_legend, palette,
};

/// A motion on a body, to be drawn over time.
#[derive(Clone, Copy, Debug)]
pub struct MotionSheet<'a> {
    /// The first line: what is shown.
    pub title: &'a str,
    /// The motion.
    pub motion: &'a Motion,
    /// The body.
    pub body: &'a Body,
    /// Self-intersection of every frame, as [`physique::Scorer::self_intersections`] measures it.
    pub intersections: &'a [FrameIntersections],
    /// How many moments to show, at least 1: evenly spread, the worst one among them.
    pub moments: usize,
}

impl MotionSheet<'_> {
    /// Poses the body, finds intersecting triangles and draws the sheet. Creases between
    /// neighbouring parts are not coloured.
    ///
    /// # Errors
    /// [`ViewError::Empty`] for a motion without frames, [`ViewError::Measure`] for a body whose
    /// surface cannot be measured, and what [`ContactSheet::render`] finds wrong.
    pub fn render(&self) -> Result<Image, ViewError> {
        let model = self.body.model();
        let triangles = Triangles::new(model.vertex_count(), model.triangles()).map_err(measure)?;
        let rest = self.body.rest_vertices();
        let mut pairs =
            TrianglePairs::new(&triangles, rest, SharedVertices::Skip).map_err(measure)?;
        let mut posed = self.body.posed();
        let moments = self
            .shown_frames()
            .into_iter()
            .map(|frame| self.moment(frame, &mut posed, &mut pairs))
            .collect::<Result<Vec<_>, _>>()?;

        let colours = side_colours(self.body);
        let mut sheet = ContactSheet::new(model.triangles(), Colours::PerVertex(&colours));
        sheet.title = self.title.to_owned();
        sheet.subtitle = self.subtitle();
        sheet.legend = body_legend();
        sheet.views = self.views();
        sheet.trajectory = self.trajectory();
        sheet.chart = Some(Chart {
            label: "Self-intersection (cm³)".into(),
            seconds_per_value: self.frame_seconds() as f32,
            values: self
                .intersections
                .iter()
                .map(|frame| frame.intersection_cm3 as f32)
                .collect(),
            colour: palette::INTERSECTION,
        });
        sheet.frames = moments
            .iter()
            .map(|moment| Frame {
                seconds: (moment.frame as f64 * self.frame_seconds()) as f32,
                positions: &moment.positions,
                highlighted: &moment.highlighted,
                note: self.note(moment.frame),
            })
            .collect();
        sheet.render()
    }

    fn frame_seconds(&self) -> f64 {
        self.motion.frame_rate().frame_seconds()
    }

    fn subtitle(&self) -> String {
        format!(
            "{:.1} s at {} frames a second, {} of {:.2} m and {:.0} kg",
            self.motion.seconds(),
            self.motion.frame_rate().per_second(),
            self.body.model().name(),
            self.body.stature(),
            self.body.mass(),
        )
    }

    fn note(&self, frame: usize) -> String {
        let volume = self.intersections.get(frame);
        volume.map_or(String::new(), |found| {
            format!("{:.0} cm³", found.intersection_cm3)
        })
    }

    /// Evenly spread frames; the one nearest to the worst frame gives way to it.
    fn shown_frames(&self) -> Vec<usize> {
        let count = self.motion.frame_count();
        let moments = self.moments.clamp(1, count.max(1));
        let last = count.saturating_sub(1);
        let mut shown: Vec<usize> = (0..moments)
            .map(|moment| (moment * last).checked_div(moments - 1).unwrap_or(last / 2))
            .collect();
        let worst = self
            .intersections
            .iter()
            .enumerate()
            .filter(|(_, found)| found.intersection_cm3 > 0.0)
            .max_by(|a, b| a.1.intersection_cm3.total_cmp(&b.1.intersection_cm3));
        if let Some((worst, _)) = worst
            && let Some(nearest) = shown.iter_mut().min_by_key(|frame| frame.abs_diff(worst))
        {
            *nearest = worst;
        }
        if count == 0 { Vec::new() } else { shown }
    }

    /// The usual views, turned so that "front" sees the body's front in the first frame.
    fn views(&self) -> Vec<View> {
        let usual = [View::FRONT, View::SIDE, View::THREE_QUARTER, View::TOP];
        let facing = match self.motion.rotations().first() {
            Some(root) => *root * Vec3::Z,
            None => Vec3::Z,
        };
        let heading = facing.x.atan2(facing.z);
        usual.map(|view| view.around(heading)).into()
    }

    fn trajectory(&self) -> Vec<Vec3> {
        let pelvis = self.body.rest_joint(Joint::Pelvis);
        let path = self.motion.root_translation().iter();
        path.map(|t| (pelvis + *t).with_y(0.0)).collect()
    }

    fn moment(
        &self,
        frame: usize,
        posed: &mut PosedBody,
        pairs: &mut TrianglePairs,
    ) -> Result<Moment, ViewError> {
        self.body
            .pose(&self.motion.pose(frame), posed)
            .map_err(measure)?;
        let model = self.body.model();
        let mut highlighted = vec![false; model.triangles().len()];
        let stature = self.body.stature() as f32;
        for &(a, b) in pairs.find(posed.vertices()).map_err(measure)? {
            let both = [a, b].map(|triangle| triangle as usize);
            let [part_a, part_b] = both.map(|triangle| model.triangle_parts()[triangle]);
            let corner = model.triangles()[both[0]][0] as usize;
            let middle = posed.vertices()[corner];
            if !is_crease(part_a, part_b, middle, stature, |joint| posed.joint(joint)) {
                both.into_iter()
                    .for_each(|triangle| highlighted[triangle] = true);
            }
        }
        Ok(Moment {
            frame,
            positions: posed.vertices().to_vec(),
            highlighted,
        })
    }
}

struct Moment {
    frame: usize,
    positions: Vec<Vec3>,
    highlighted: Vec<bool>,
}

/// The left side bluish, the right side warm, the trunk between: left stays left in every picture.
pub fn side_colours(body: &Body) -> Vec<Colour> {
    let parts = body.model().vertex_parts().iter();
    parts
        .map(|part| match part.name() {
            name if name.starts_with("left") => palette::LEFT,
            name if name.starts_with("right") => palette::RIGHT,
            _ => palette::CENTRE,
        })
        .collect()
}

fn measure(problem: impl std::fmt::Display) -> ViewError {
    ViewError::Measure {
        problem: problem.to_string(),
    }
}
