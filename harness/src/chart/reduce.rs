//! Reduces the points of long lines without changing their look.

/// A place in the drawing.
pub(super) type Place = [f64; 2];

/// Shorter lines are left as they are.
const LONG: usize = 400;

/// The lowest and the highest place of each column one unit wide, in their order, so that spikes
/// stay.
pub(super) fn by_column(line: &[Place]) -> Vec<Place> {
    if line.len() <= LONG {
        return line.to_vec();
    }
    let column = |place: &Place| place.first().map_or(0, |x| x.floor() as i64);
    line.chunk_by(|a, b| column(a) == column(b)).flat_map(extremes).collect()
}

fn extremes(places: &[Place]) -> impl Iterator<Item = Place> + use<> {
    let by_height = |a: &(usize, &Place), b: &(usize, &Place)| a.1[1].total_cmp(&b.1[1]);
    let least = places.iter().enumerate().min_by(by_height);
    let most = places.iter().enumerate().max_by(by_height);
    let mut ends = [least, most].map(|end| end.map(|(ix, place)| (ix, *place)));
    ends.sort_by_key(|end| end.map(|(ix, _)| ix));
    if ends[0] == ends[1] {
        ends[1] = None;
    }
    ends.into_iter().flatten().map(|(_, place)| place)
}
