//! The maps of one rectangle that frames subdivide: which place of the atlas holds which point.

use std::ops::Range;

use assign::{Emitter, Light};
use glam::{Mat4, Vec3};

use super::{
    face::Face,
    plan::{Site, point_record},
    quadtree::{Change, Node, POINTS, Quadtree, place_of, uniform_points},
};

/// A rectangle with its tree and its places. A place is room for one map, with fixed faces in the atlas.
#[derive(Debug)]
pub(super) struct Rectangle {
    site: Site,
    emitter: Emitter,
    position: Vec3,
    /// The farthest that it lights a sample, from its middle, metres.
    reach_m: f32,
    /// The vector of its record that holds the number of its maps, without that.
    record: [u32; 4],
    /// The last two vectors of the record of each place: where its faces lie.
    addresses: Vec<[[u32; 4]; 2]>,
    /// The place of each point that has a map.
    places: Vec<Option<usize>>,
    tree: Quadtree,
}

/// A face that looks from another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MovedFace {
    /// Its index.
    pub(super) face: usize,
    /// The point, world space.
    pub(super) eye: Vec3,
    pub(super) world_to_view: Mat4,
}

/// What changes when points come and go: vectors of the records, each with its index, and faces that must be drawn,
/// with their new transforms from world to view space.
#[derive(Debug, Default)]
pub(super) struct Patch {
    pub(super) records: Vec<(usize, Vec<[u32; 4]>)>,
    pub(super) faces: Vec<MovedFace>,
    /// The number of maps that these are the faces of.
    pub(super) maps: u32,
}

impl Patch {
    /// Turns the faces to their new points.
    pub(super) fn move_faces(&self, faces: &mut [Face]) {
        for MovedFace { face, eye, world_to_view } in &self.faces {
            faces[*face] = Face { eye: *eye, world_to_view: *world_to_view, ..faces[*face] };
        }
    }
}

impl Rectangle {
    /// A rectangle without maps at its site. `records` are those of the plan.
    pub(super) fn new(
        site: Site,
        light: &Light,
        emitter: Emitter,
        records: &[[u32; 4]],
        most: u32,
    ) -> Self {
        let address = |place: usize| {
            let map = site.first_map + 3 * place;
            [records[map + 1], records[map + 2]]
        };
        let mut record = records[count_vector(site.light)];
        record[3] -= most;
        Self {
            record,
            addresses: (0..most as usize).map(address).collect(),
            emitter,
            position: light.position,
            reach_m: light.range_m + emitter.radius(),
            site,
            places: vec![None; POINTS],
            tree: Quadtree::uniform(0),
        }
    }

    /// Its slot.
    pub(super) fn light(&self) -> usize {
        self.site.light
    }

    pub(super) fn emitter(&self) -> &Emitter {
        &self.emitter
    }

    pub(super) fn position(&self) -> Vec3 {
        self.position
    }

    pub(super) fn reach_m(&self) -> f32 {
        self.reach_m
    }

    /// The number of its maps.
    pub(super) fn maps(&self) -> u32 {
        self.places.iter().flatten().count() as u32
    }

    /// The most maps that it can have.
    fn most(&self) -> u32 {
        self.addresses.len() as u32
    }

    /// Divides it evenly, as finely as `level` and its places allow.
    pub(super) fn start_at(&mut self, level: u32) {
        let fits = |level: &u32| uniform_points(*level) <= self.most();
        let level = (0..=level).rfind(fits).unwrap_or(0);
        self.tree = Quadtree::uniform(level);
    }

    /// Whether it has no places left for some quad.
    pub(super) fn is_full(&self) -> bool {
        self.tree.is_full(self.most())
    }

    /// The quads to test.
    pub(super) fn tests(&self) -> Vec<Node> {
        self.tree.tests(self.most())
    }

    /// Takes which of the tested quads have bands.
    pub(super) fn refine(&mut self, tested: &[(Node, bool)]) -> Change {
        let most = self.most();
        self.tree.refine(tested, most)
    }

    /// Frees the places of points that are no corners any more, and gives those that became corners free ones.
    pub(super) fn place_points(&mut self, patch: &mut Patch) {
        let weights = self.tree.weights();
        for (place, weight) in self.places.iter_mut().zip(&weights) {
            *place = place.filter(|_| *weight > 0);
        }
        let mut is_free = vec![true; self.addresses.len()];
        self.places.iter().flatten().for_each(|place| is_free[*place] = false);
        // The tree has at most as many points as there are places.
        let mut free = (0..is_free.len()).filter(|place| is_free[*place]);
        let mut records = Vec::new();
        for (point, weight) in weights.into_iter().enumerate().filter(|(_, weight)| *weight > 0) {
            let eye = self.eye(point);
            let place = match self.places[point] {
                Some(place) => place,
                None => {
                    let Some(place) = free.next() else { break };
                    self.places[point] = Some(place);
                    patch.maps += 1;
                    let first = self.site.first_face + place * self.site.face_count;
                    patch.faces.extend((0..self.site.face_count).map(|face| MovedFace {
                        face: first + face,
                        eye,
                        world_to_view: self.site.world_to_view(face, eye.as_dvec3()),
                    }));
                    place
                }
            };
            records.push(point_record(eye, weight));
            records.extend(self.addresses[place]);
        }
        let [x, y, z, flags] = self.record;
        let record = vec![[x, y, z, flags + self.maps()]];
        patch.records.push((count_vector(self.site.light), record));
        patch.records.push((self.site.first_map, records));
    }

    /// A point in world space, rounded as the fixed points of a rectangle are.
    fn eye(&self, point: usize) -> Vec3 {
        let [x, y] = self.emitter.half_axes().map(Vec3::as_dvec3);
        let [i, j] = place_of(point);
        (self.position.as_dvec3() + (x * i + y * j)).as_vec3()
    }

    /// The indices of the faces of all of its maps.
    pub(super) fn faces(&self) -> impl Iterator<Item = usize> + '_ {
        let Site { first_face, face_count, .. } = self.site;
        let first = move |place: &usize| first_face + place * face_count;
        self.places.iter().flatten().flat_map(move |place| first(place)..first(place) + face_count)
    }

    /// The indices of the faces of all of its places.
    pub(super) fn all_faces(&self) -> Range<usize> {
        let first = self.site.first_face;
        first..first + self.addresses.len() * self.site.face_count
    }

    /// The vectors in the records of the maps at the corners of a quad.
    pub(super) fn corner_maps(&self, node: Node) -> [u32; 4] {
        node.corners().map(|point| {
            let before = self.places[..point].iter().flatten().count();
            (self.site.first_map + 3 * before) as u32
        })
    }
}

/// The vector in the records that holds the number of a light's maps: `shadow_light` of `shadow.wesl`.
fn count_vector(light: usize) -> usize {
    3 * light + 2
}
