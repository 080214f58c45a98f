//! Places everything in the town.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::{Mat4, Vec3};
use rand::RngExt;

use super::{
    Thing, Town, church, furniture,
    house::Design,
    kit::Parts,
    land::{BLOCK_M, Land, Lot, MEADOW_M, STREET_M},
    materials::Surface,
    paving, plants,
};
use crate::builder::Builder;

/// Width of the pavement around a block, metres.
const PAVEMENT_M: f32 = 1.1;

/// Side of a house's lot, three to a block, metres.
const LOT_M: f32 = (BLOCK_M - 2.0 * PAVEMENT_M) / 3.0;

/// Depth of houses between others, metres.
const DEPTH_M: f32 = 6.4;

/// Side of a patch of grass blades, metres.
const TUFTS_M: f32 = 8.0;

/// Everything that is placed more than once.
struct Stock {
    houses: Vec<Thing>,
    corners: Vec<Thing>,
    trees: Vec<Thing>,
    conifer: Thing,
    bush: Thing,
    tufts: Thing,
    patches: Vec<Thing>,
    pavement: Thing,
    lamp: Thing,
    bench: Thing,
    fence: Thing,
    barrel: Thing,
}

fn one(surface: Surface, builder: Builder) -> Parts {
    Parts(vec![(surface, builder)])
}

fn turned(turn: f32) -> Mat4 {
    Mat4::from_rotation_y(turn)
}

fn moved(x: f32, z: f32) -> Mat4 {
    Mat4::from_translation(Vec3::new(x, 0.0, z))
}

impl Town {
    /// Makes and places everything.
    pub(super) fn build(&mut self, land: &Land) {
        let stock = self.stock();
        self.ground(land);
        self.streets(land, &stock);
        for x in 0..land.blocks {
            for z in 0..land.blocks {
                if land.is_square(x, z) {
                    continue;
                }
                let ((x0, x1), (z0, z1)) = (land.block(x), land.block(z));
                let lot = Lot { min: [x0, z0], max: [x1, z1] };
                self.place(&stock.pavement, land.on(lot));
                self.lamps(land, lot, &stock);
                // A few blocks are gardens, but never at the main street's end or the town's edge.
                let inner = |ix: u32| ix > 0 && ix + 1 < land.blocks;
                if inner(x) && inner(z) && (x + 2 * z) % 5 == 2 {
                    self.garden(land, lot, &stock);
                } else {
                    self.block(land, lot, &stock);
                }
            }
        }
        self.square(land, &stock);
        self.meadow(land, &stock);
    }

    fn stock(&mut self) -> Stock {
        let fine = self.fine;
        let (houses, corners) = if fine { (10, 6) } else { (4, 3) };
        let mut house = |corner: bool| {
            let depth = if corner { LOT_M } else { DEPTH_M };
            let design = Design::random(&mut self.rng, [LOT_M - 0.04, depth - 0.04], corner, fine);
            let parts = design.build(&mut self.rng);
            self.thing("house", parts)
        };
        let houses = (0..houses).map(|_| house(false)).collect();
        let corners = (0..corners).map(|_| house(true)).collect();
        let mut tree = |surface: Surface| {
            let parts = plants::broadleaf(&mut self.rng, surface, fine);
            self.thing("tree", parts)
        };
        let trees = vec![tree(Surface::Leaf), tree(Surface::Leaf), tree(Surface::LeafDark)];
        let conifer = plants::conifer(&mut self.rng, fine);
        let bush = plants::bush(&mut self.rng, fine);
        let tufts = plants::tufts(&mut self.rng, TUFTS_M, if fine { 200 } else { 6 });
        let setts = if fine { 11 } else { 1 };
        let patches = (0..if fine { 3 } else { 1 })
            .map(|_| {
                let patch = paving::patch(&mut self.rng, setts);
                self.thing("setts", patch)
            })
            .collect();
        let block = Lot { min: [0.0; 2], max: [BLOCK_M; 2] };
        let slab = if fine { 0.5 * PAVEMENT_M } else { 2.0 * PAVEMENT_M };
        let hole = BLOCK_M - 2.0 * PAVEMENT_M;
        let pavement = paving::flags(&mut self.rng, block, hole, slab, 0.14);
        Stock {
            houses,
            corners,
            trees,
            conifer: self.thing("conifer", conifer),
            bush: self.thing("bush", bush),
            tufts: self.thing("grass", one(Surface::Grass, tufts)),
            patches,
            pavement: self.thing("pavement", one(Surface::Flag, pavement)),
            lamp: self.thing("lamp", furniture::lamp(fine)),
            bench: self.thing("bench", furniture::bench(fine)),
            fence: self.thing("fence", furniture::fence(LOT_M, fine)),
            barrel: self.thing("barrel", furniture::barrel(fine)),
        }
    }

    /// The ground: earth under the streets, grass elsewhere.
    fn ground(&mut self, land: &Land) {
        let mut parts = Parts::default();
        let (xs, zs): (Vec<_>, Vec<_>) = (land.knots(0).collect(), land.knots(1).collect());
        for (i, x) in xs.windows(2).enumerate() {
            for (j, z) in zs.windows(2).enumerate() {
                let at = |x: f32, z: f32| Vec3::new(x, land.height(x, z), z);
                let corner = at(x[0], z[0]);
                // Odd intervals of the knots are streets. The first and the last are meadow.
                let street = |ix: usize, last: usize| ix % 2 == 1 && ix < last;
                let meadow = i == 0 || j == 0 || i + 2 == xs.len() || j + 2 == zs.len();
                let paved = street(i, xs.len() - 2) || street(j, zs.len() - 2);
                let surface = if paved && !meadow { Surface::Earth } else { Surface::Grass };
                let (u, v) = (at(x[0], z[1]) - corner, at(x[1], z[0]) - corner);
                parts.mesh(surface).quad(corner, u, v);
            }
        }
        let ground = self.thing("ground", parts);
        self.place(&ground, Mat4::IDENTITY);
    }

    /// Setts on every street and crossing outside the square.
    fn streets(&mut self, land: &Land, stock: &Stock) {
        let half = 0.5 * land.side_m();
        let (first, count) = land.square();
        let low = land.block(first).0;
        let high = land.block(first + count - 1).1;
        let steps = (land.side_m() / paving::PATCH_M).round() as u32;
        let along = |ix: u32| ix as f32 * paving::PATCH_M - half;
        // Two of every eight patches are street.
        let is_street = |ix: u32| ix % 8 < 2;
        for x in 0..steps {
            for z in 0..steps {
                let min = [along(x), along(z)];
                let in_square = min.iter().all(|m| (low - 0.1..high - 0.1).contains(m));
                if in_square || !(is_street(x) || is_street(z)) {
                    continue;
                }
                let lot = Lot { min, max: min.map(|m| m + paving::PATCH_M) };
                let turn = FRAC_PI_2 * self.rng.random_range(0..4) as f32;
                self.place_any(&stock.patches, land.on(lot) * turned(turn));
            }
        }
    }

    /// Lamps on the pavement, at the corners of a block.
    fn lamps(&mut self, land: &Land, lot: Lot, stock: &Stock) {
        let [x, z] = lot.center();
        let reach = 0.5 * BLOCK_M - 0.35;
        for (dx, dz) in [(-reach, -0.8 * reach), (reach, 0.8 * reach)] {
            self.place(&stock.lamp, land.at(x + dx, z + dz));
        }
    }

    /// Eight houses around a yard.
    fn block(&mut self, land: &Land, lot: Lot, stock: &Stock) {
        let [x, z] = lot.center();
        for quarter in 0..4 {
            let turn = turned(FRAC_PI_2 * quarter as f32);
            let stand = |town: &mut Self, houses: &[Thing], along: f32, back: f32| {
                let at = turn.transform_point3(Vec3::new(along, 0.0, back));
                town.place_any(houses, land.at(x + at.x, z + at.z) * turn);
            };
            stand(self, &stock.corners, LOT_M, LOT_M);
            stand(self, &stock.houses, 0.0, LOT_M + 0.5 * (LOT_M - DEPTH_M));
        }
        self.place(&stock.tufts, land.on(lot));
        let spin = turned(TAU * self.rng.random::<f32>());
        self.place_any(&stock.trees, land.at(x, z) * spin);
        for _ in 0..2 {
            let [dx, dz] = [(); 2].map(|()| 5.0 * self.rng.random::<f32>() - 2.5);
            self.place(&stock.bush, land.at(x + dx, z + dz));
        }
        if self.rng.random::<f32>() < 0.6 {
            let reach = 0.5 * BLOCK_M - 0.6;
            let side = 3.0 * (self.rng.random::<f32>() - 0.5);
            self.place(&stock.barrel, land.at(x - reach, z + side));
            self.place(&stock.barrel, land.at(x - reach + 0.1, z + side + 0.8));
        }
    }

    /// A garden: lawn, fence, trees, bushes and benches.
    fn garden(&mut self, land: &Land, lot: Lot, stock: &Stock) {
        let [x, z] = lot.center();
        for quarter in 0..4 {
            let turn = turned(FRAC_PI_2 * quarter as f32);
            for along in [-LOT_M, LOT_M] {
                let at = turn.transform_point3(Vec3::new(along, 0.0, 1.5 * LOT_M));
                self.place(&stock.fence, land.at(x + at.x, z + at.z) * turn);
            }
            let at = turn.transform_point3(Vec3::new(3.0, 0.0, 3.0));
            self.place(&stock.bench, land.at(x + at.x, z + at.z) * turn);
        }
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i as f32 - 1.0, j as f32 - 1.0))) {
            let patch = Lot {
                min: [x + TUFTS_M * (i - 0.5) * 0.9, z + TUFTS_M * (j - 0.5) * 0.9],
                max: [x + TUFTS_M * (i + 0.5) * 0.9, z + TUFTS_M * (j + 0.5) * 0.9],
            };
            self.place(&stock.tufts, land.on(patch) * Mat4::from_scale(Vec3::new(0.9, 1.0, 0.9)));
            let jitter = |town: &mut Self| 2.0 * town.rng.random::<f32>() - 1.0;
            let (tx, tz) = (x + 6.4 * i + jitter(self), z + 6.4 * j + jitter(self));
            if (i, j) != (0.0, 0.0) {
                self.tree(land, tx, tz, stock);
                self.place(&stock.bush, land.at(tx + 1.8, tz - 1.4));
            }
        }
    }

    /// A tree of any kind and size.
    fn tree(&mut self, land: &Land, x: f32, z: f32, stock: &Stock) {
        let size = 0.75 + 0.5 * self.rng.random::<f32>();
        let spin = turned(TAU * self.rng.random::<f32>());
        let at = land.at(x, z) * spin * Mat4::from_scale(Vec3::splat(size));
        if self.rng.random::<f32>() < 0.25 {
            self.place(&stock.conifer, at);
        } else {
            self.place_any(&stock.trees, at);
        }
    }

    /// Flagstones, church, fountain, stalls, trees and benches.
    fn square(&mut self, land: &Land, stock: &Stock) {
        let fine = self.fine;
        let (first, count) = land.square();
        let (low, side) = (land.block(first).0, count as f32 * (BLOCK_M + STREET_M) - STREET_M);
        let middle = low + 0.5 * side;
        let quarter = Lot { min: [0.0; 2], max: [0.5 * side; 2] };
        let slab = if fine { 0.8 } else { 4.0 };
        let flags = paving::flags(&mut self.rng, quarter, 0.0, slab, 0.06);
        let flags = self.thing("flagstones", one(Surface::Flag, flags));
        for (dx, dz) in [(0.0, 0.0), (0.5, 0.0), (0.0, 0.5), (0.5, 0.5)] {
            let min = [low + dx * side, low + dz * side];
            self.place(&flags, land.on(Lot { min, max: min.map(|m| m + 0.5 * side) }));
        }
        let church = self.thing("church", church::church(fine));
        let scale = if count > 1 { 1.0 } else { 0.7 };
        let stand = land.at(middle, middle - 0.16 * side);
        self.place(&church, stand * Mat4::from_scale(Vec3::splat(scale)));
        if count < 2 {
            return;
        }
        let fountain = self.thing("fountain", furniture::fountain(fine));
        self.place(&fountain, land.at(middle, middle + 0.2 * side));
        let stall = self.thing("stall", furniture::stall(fine));
        let cart = self.thing("cart", furniture::cart());
        for i in 0..5 {
            for sign in [-1.0, 1.0] {
                let (x, z) = (middle + sign * 0.27 * side, middle + 4.4 * i as f32 - 2.0);
                self.place(&stall, land.at(x, z) * turned(-sign * FRAC_PI_2));
                self.place(&stock.barrel, land.at(x + sign * 2.0, z + 1.9));
            }
        }
        self.place(&cart, land.at(middle - 9.0, middle + 15.0) * turned(0.7));
        self.place(&cart, land.at(middle + 9.5, middle + 21.0) * turned(2.5));
        for i in 0..7 {
            for sign in [-1.0, 1.0] {
                let (x, z) = (middle + sign * 0.43 * side, low + side * (i as f32 + 0.5) / 7.0);
                self.tree(land, x, z, stock);
                self.place(&stock.bench, land.at(x - sign * 1.6, z) * turned(-sign * FRAC_PI_2));
            }
        }
    }

    /// Grass, trees and a fence around the town.
    fn meadow(&mut self, land: &Land, stock: &Stock) {
        let inner = 0.5 * land.side_m();
        let outer = inner + MEADOW_M;
        let cells = (2.0 * outer / TUFTS_M) as u32;
        for x in 0..cells {
            for z in 0..cells {
                let min = [x, z].map(|ix| ix as f32 * TUFTS_M - outer);
                let lot = Lot { min, max: min.map(|m| m + TUFTS_M) };
                let [cx, cz] = lot.center();
                if cx.abs().max(cz.abs()) < inner {
                    continue;
                }
                self.place(&stock.tufts, land.on(lot));
                // Keep clear of the main street's end, where the camera starts.
                let open = cz > 0.0 && cx.abs() < inner;
                if self.rng.random::<f32>() < if open { 0.06 } else { 0.4 } {
                    let [dx, dz] = [(); 2].map(|()| 4.0 * self.rng.random::<f32>() - 2.0);
                    self.tree(land, cx + dx, cz + dz, stock);
                }
            }
        }
        let count = (2.0 * outer / LOT_M) as u32;
        for quarter in 0..4 {
            let turn = turned(FRAC_PI_2 * quarter as f32);
            for i in 0..count {
                let along = (i as f32 + 0.5 - 0.5 * count as f32) * LOT_M;
                let at = (turn * moved(along, outer - 0.5)).transform_point3(Vec3::ZERO);
                self.place(&stock.fence, land.at(at.x, at.z) * turn);
            }
        }
    }
}
