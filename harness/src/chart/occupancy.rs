//! The room for labels that is left in a drawing.

/// A box in the drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Area {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

impl Area {
    pub(super) fn around([x, y]: [f64; 2], radius: f64) -> Self {
        Self { left: x - radius, top: y - radius, right: x + radius, bottom: y + radius }
    }

    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    fn contains(&self, other: &Self) -> bool {
        other.left >= self.left
            && other.top >= self.top
            && other.right <= self.right
            && other.bottom <= self.bottom
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Free,
    /// A line: a label may cross it, but another place is better.
    Crossed,
    Taken,
}

const CELL: f64 = 3.0;
/// The share of a label's area that lines may cross.
const MOST_CROSSED: f64 = 0.3;

/// A raster over the plot that marks which places are taken.
pub(super) struct Occupancy {
    bounds: Area,
    columns: usize,
    cells: Vec<Cell>,
}

impl Occupancy {
    pub(super) fn new(bounds: Area) -> Self {
        let columns = (bounds.width() / CELL).ceil().max(1.0) as usize;
        let rows = (bounds.height() / CELL).ceil().max(1.0) as usize;
        Self { bounds, columns, cells: vec![Cell::Free; columns * rows] }
    }

    fn indices(&self, area: &Area) -> impl Iterator<Item = usize> + use<> {
        let index = |length: f64| (length / CELL).floor().max(0.0) as usize;
        let columns = self.columns;
        let last = columns.saturating_sub(1);
        let across =
            index(area.left - self.bounds.left)..=index(area.right - self.bounds.left).min(last);
        let rows = self.cells.len() / columns.max(1);
        let down = index(area.top - self.bounds.top)
            ..=index(area.bottom - self.bounds.top).min(rows.saturating_sub(1));
        down.flat_map(move |row| across.clone().map(move |column| row * columns + column))
    }

    /// Keeps labels out of an area.
    pub(super) fn take(&mut self, area: &Area) {
        for ix in self.indices(area) {
            if let Some(cell) = self.cells.get_mut(ix) {
                *cell = Cell::Taken;
            }
        }
    }

    /// A line passes here; labels keep off a `solid` one.
    pub(super) fn cross(&mut self, from: [f64; 2], to: [f64; 2], solid: bool) {
        let mark = if solid { Cell::Taken } else { Cell::Crossed };
        let steps = ((to[0] - from[0]).hypot(to[1] - from[1]) / CELL).ceil().clamp(1.0, 1e3);
        for step in 0..=steps as u32 {
            let t = f64::from(step) / steps;
            let at = [from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t];
            for ix in self.indices(&Area::around(at, 0.5)) {
                if let Some(cell) = self.cells.get_mut(ix).filter(|cell| **cell == Cell::Free) {
                    *cell = mark;
                }
            }
        }
    }

    /// The share of the area that lines cross; nothing where no label may be.
    fn crossed(&self, area: &Area) -> Option<f64> {
        if !self.bounds.contains(area) {
            return None;
        }
        let (mut crossed, mut all) = (0.0, 0.0_f64);
        for ix in self.indices(area) {
            match self.cells.get(ix) {
                Some(Cell::Taken) | None => return None,
                Some(Cell::Crossed) => crossed += 1.0,
                Some(Cell::Free) => {}
            }
            all += 1.0;
        }
        Some(crossed / all.max(1.0)).filter(|&share| share <= MOST_CROSSED)
    }

    /// The best place for a label of this size beside a point, and how bad it is; `level` leaves
    /// only places at the point's own height.
    pub(super) fn beside(
        &self,
        [x, y]: [f64; 2],
        [width, height]: [f64; 2],
        level: bool,
    ) -> Option<(Area, f64)> {
        const GAP: f64 = 8.0;
        let (left, middle, right) = (x - GAP - width, x - width * 0.5, x + GAP);
        let (above, own, below) = (y - GAP - height, y - height * 0.5, y + GAP);
        let corner = GAP * 0.4;
        let places = [
            (right, own),
            (left, own),
            (middle, above),
            (middle, below),
            (right - corner, above + corner),
            (right - corner, below - corner),
            (left + corner, above + corner),
            (left + corner, below - corner),
        ];
        places
            .into_iter()
            .take(if level { 2 } else { 8 })
            .zip(0_u32..)
            .filter_map(|((left, top), rank)| {
                let area = Area { left, top, right: left + width, bottom: top + height };
                let crossed = self.crossed(&area)?;
                Some((area, crossed * 3.0 + f64::from(rank) * 0.01))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }
}
