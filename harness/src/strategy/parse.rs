//! Reads ids, and rejects segments that contradict each other.

use assign::{AreaBounds, LightSource, Storage};
use assign_clustered::SpecularCut;
use thiserror::Error;

use super::{Axis, Options, Row, row, rows};

/// Why an id cannot be run.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum IdError {
    /// No row has this family.
    #[error("no strategy called {id}")]
    Unknown {
        /// The id.
        id: String,
    },
    /// A segment cannot stand in the id.
    #[error("strategy {id}: {reason}")]
    Segment {
        /// The id.
        id: String,
        /// The segment, and what the family accepts.
        reason: String,
    },
}

/// Reads an id that this program can run.
pub(super) fn parse(id: &str) -> Result<(&'static Row, Options), IdError> {
    let mut segments = id.split('/');
    let family = segments.next().unwrap_or_default();
    let same = |row: &&Row| row.family.eq_ignore_ascii_case(family);
    let row = rows().find(same).ok_or_else(|| IdError::Unknown { id: id.to_owned() })?;
    let mut reader = Reader { id, row, options: Options::default(), set: Vec::new() };
    for segment in segments {
        let segment = segment.to_lowercase();
        match Axis::of_segment(&segment) {
            Some(axis) => reader.set_axis(axis, segment)?,
            None => reader.set_parameters(segment)?,
        }
    }
    let mut options = reader.options;
    check_pairs(id, row, &options)?;
    if options.parameters.is_empty() {
        row.default.clone_into(&mut options.parameters);
    }
    Ok((row, options))
}

/// Reads what can be read of an id that this program cannot run: a result of another program, or of a
/// later version. The id keeps its text.
pub(super) fn read_foreign(id: &str) -> (Option<&'static Row>, Options) {
    let mut options = Options::default();
    let mut segments = id.split('/');
    let row = segments.next().and_then(row);
    for segment in segments {
        let lower = segment.to_lowercase();
        match Axis::of_segment(&lower) {
            // A segment without a valid value changes nothing.
            Some(axis) => drop(axis.set(&mut options, &lower)),
            None if options.parameters.is_empty() && starts_with_digit(segment) => {
                segment.clone_into(&mut options.parameters);
            }
            None => {}
        }
    }
    (row, options)
}

/// Rejects options that contradict each other. Options of the command line may, as segments may.
pub(super) fn check_pairs(id: &str, row: &Row, options: &Options) -> Result<(), IdError> {
    if options.specular == SpecularCut::WhereDiffuse
        && let Some(normals) = Axis::Normals.segment(options)
    {
        return Err(contradiction(
            id,
            "dif",
            &normals,
            "`dif` cannot be combined with normal cones",
        ));
    }
    if let (true, Some(cascades)) = (options.slices.is_cascaded(), Axis::Slices.segment(options)) {
        if ["DA-I", "DA-E", "ZB"].contains(&row.family) {
            let reason = "its tiles have one size in all slices";
            return Err(contradiction(id, row.family, &cascades, reason));
        }
        if let Some(normals) = Axis::Normals.segment(options) {
            let reason = "clusters that are split by normals have tiles of one size";
            return Err(contradiction(id, &cascades, &normals, reason));
        }
    }
    if options.storage == Storage::ScalarMasks
        && let Some(other) = Axis::Cap.segment(options).or_else(|| Axis::Reuse.segment(options))
    {
        let reason = "pixels would read lights that are only in the lists of others";
        return Err(contradiction(id, "scalar", &other, reason));
    }
    if let Some(stochastic) = Axis::Stochastic.segment(options) {
        let others = [Axis::Keep, Axis::Touched, Axis::Reuse];
        if let Some(other) = others.into_iter().find_map(|axis| axis.segment(options)) {
            let reason = "ranges that are random differ from frame to frame";
            return Err(contradiction(id, &stochastic, &other, reason));
        }
    }
    if let (Some(fewer), Some(source)) = (
        Axis::Fewer.segment(options),
        Axis::Keep.segment(options).or_else(|| Axis::Touched.segment(options)),
    ) {
        let reason = "a light that moves may leave the frame's lights, or enter them";
        return Err(contradiction(id, &fewer, &source, reason));
    }
    if let Some(reach) = Axis::Reach.segment(options) {
        let at_range = "its clusters end at the lights' ranges";
        for (other, reason) in [
            (Axis::Normals, at_range),
            (Axis::Specular, at_range),
            (Axis::Storage, "only plain lists hold lights beyond their range"),
            (Axis::Touched, "changed lights are looked for within their range"),
        ] {
            if let Some(segment) = other.segment(options) {
                return Err(contradiction(id, &reach, &segment, reason));
            }
        }
    }
    for (flaw, other, reason) in [
        (
            Axis::Half,
            Axis::Keep,
            "lists that are kept hold larger lights, which hides the rounding",
        ),
        (Axis::Half, Axis::Touched, "both choose the lights that lists are made for"),
        (Axis::Order, Axis::Storage, "only a plain list can be read in any order"),
        (Axis::Order, Axis::Reuse, "both say what lists are in a frame"),
        (Axis::Order, Axis::Keep, "both say what lists are in a frame"),
        (Axis::Order, Axis::Touched, "both say what lists are in a frame"),
    ] {
        if let (Some(flaw), Some(other)) = (flaw.segment(options), other.segment(options)) {
            return Err(contradiction(id, &flaw, &other, reason));
        }
    }
    for (other, reason) in [
        (Axis::Normals, "a list that is split by normals may change though its lights do not"),
        (Axis::Cap, "a list with a cap does not tell which lights it lacks"),
        (Axis::Reuse, "both say when lists are made again"),
        (Axis::Keep, "both say when lists are made again"),
    ] {
        if options.is_touched
            && let Some(segment) = other.segment(options)
        {
            return Err(contradiction(id, "touched", &segment, reason));
        }
    }
    if let Some(hidden) = Axis::Occlusion.segment(options) {
        let others = [Axis::Keep, Axis::Touched, Axis::Reuse];
        if let Some(other) = others.into_iter().find_map(|axis| axis.segment(options)) {
            let reason = "shadow maps hold for one frame's lights, and lists that hide lights for its groups";
            return Err(contradiction(id, &hidden, &other, reason));
        }
    }
    check_storage(id, options)?;
    let settings = options.settings();
    let is_ball = settings.area_bounds == AreaBounds::Ball;
    if is_ball && settings.source == LightSource::Hierarchy && row.has_axis(Axis::Source) {
        // Its lists would not be those of balls.
        let reason = "the hierarchy's nodes bound the lights' outlines, not their balls";
        return Err(contradiction(id, "ball", "bvh", reason));
    }
    Ok(())
}

/// Rejects options that contradict where lights are kept.
fn check_storage(id: &str, options: &Options) -> Result<(), IdError> {
    let storage = options.storage;
    let Some(name) = storage.name() else { return Ok(()) };
    let later = "the depths of a tree hold for the view and the lights of the frame that made it";
    for (other, is_refused, reason) in [
        (Axis::Specular, storage.is_mask(), "a mask cannot store which terms to leave out"),
        (Axis::Reuse, !storage.serves_later_frames(), later),
        (Axis::Keep, !storage.serves_later_frames(), later),
        (Axis::Touched, !storage.serves_later_frames(), later),
    ] {
        if is_refused && let Some(segment) = other.segment(options) {
            return Err(contradiction(id, name, &segment, reason));
        }
    }
    Ok(())
}

/// An id on its way through its segments.
struct Reader<'a> {
    id: &'a str,
    row: &'static Row,
    options: Options,
    /// The axes set so far, each with the segment that set it.
    set: Vec<(Axis, String)>,
}

impl Reader<'_> {
    fn set_axis(&mut self, axis: Axis, segment: String) -> Result<(), IdError> {
        if !self.row.has_axis(axis) {
            return Err(refuse(self.id, self.row, &segment));
        }
        if let Some((_, earlier)) = self.set.iter().find(|(known, _)| *known == axis) {
            let reason = format!("only one segment may be {}", axis.accepted());
            return Err(contradiction(self.id, earlier, &segment, &reason));
        }
        axis.set(&mut self.options, &segment)
            .ok_or_else(|| faulty(self.id, &segment, axis.accepted()))?;
        self.set.push((axis, segment));
        Ok(())
    }

    fn set_parameters(&mut self, segment: String) -> Result<(), IdError> {
        let earlier = &self.options.parameters;
        if !earlier.is_empty() && starts_with_digit(&segment) {
            let what = self.row.parameters.join(" x ");
            let reason = format!("only one segment may be {what}");
            return Err(contradiction(self.id, earlier, &segment, &reason));
        }
        let parameters = numbers(&segment, self.row.parameters.len());
        let names = self.row.parameters;
        self.options.parameters = parameters.ok_or_else(|| {
            if !names.is_empty() && starts_with_digit(&segment) {
                faulty(self.id, &segment, &names.join(" x "))
            } else {
                refuse(self.id, self.row, &segment)
            }
        })?;
        Ok(())
    }
}

/// The error of a segment that a family does not have.
pub(super) fn refuse(id: &str, row: &Row, segment: &str) -> IdError {
    let mut accepted: Vec<String> = Vec::new();
    if !row.parameters.is_empty() {
        accepted.push(row.parameters.join(" x "));
    }
    accepted.extend(row.axes.iter().map(|axis| axis.accepted().to_owned()));
    let accepted = if accepted.is_empty() {
        "nothing after a slash".to_owned()
    } else {
        format!("segments that are {}", accepted.join(", or "))
    };
    let reason = format!("{segment:?} is unknown: {} takes {accepted}", row.family);
    IdError::Segment { id: id.to_owned(), reason }
}

/// The error of a segment whose value is faulty.
fn faulty(id: &str, segment: &str, accepted: &str) -> IdError {
    let reason = format!("{segment:?} is faulty: it must be {accepted}");
    IdError::Segment { id: id.to_owned(), reason }
}

/// Two segments that cannot stand in one id.
fn contradiction(id: &str, first: &str, second: &str, reason: &str) -> IdError {
    let reason = match first == second {
        true => format!("{first:?} is given twice: it must be given once"),
        false => format!("{first:?} and {second:?} contradict each other: {reason}"),
    };
    IdError::Segment { id: id.to_owned(), reason }
}

fn starts_with_digit(segment: &str) -> bool {
    segment.starts_with(|c: char| c.is_ascii_digit())
}

/// Numbers joined by `x`, each written in the shortest way; `None` where they are not `count` numbers.
fn numbers(segment: &str, count: usize) -> Option<String> {
    let number = |part: &str| {
        let whole = part.parse::<u64>().map(|number| number.to_string());
        whole.or_else(|_| part.parse::<f32>().map(|number| number.to_string())).ok()
    };
    let numbers: Vec<String> = segment.split('x').map(number).collect::<Option<_>>()?;
    (numbers.len() == count).then(|| numbers.join("x"))
}
