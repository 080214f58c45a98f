//! The quads of a rectangle, and the points at their corners (Dobetsberger 2025, section 6.3 and algorithm 1).
//!
//! A leaf is a quad of the emitter, and its corners are points with shadow maps. Its share of the light is its area, and
//! each corner has a quarter of that. In units of the smallest quad, weights are whole numbers: those of all points
//! sum to four times the smallest quads, however the rectangle is divided. Leaves that touch share corners.
//!
//! # A round
//!
//! [`Quadtree::tests`] names the nodes whose quads are tested for bands. [`Quadtree::refine`] takes the answers:
//!
//! 1. A parent of idle leaves without bands is pruned: its quad becomes a leaf.
//! 2. A leaf with bands is expanded into four, if the new points do not exceed the most.
//!
//! A leaf is idle if it is as old as the last round. The paper expands first. Its trees are the same, because pruning
//! takes what was expanded below, but here the points that pruning frees are free for others in the same round.
//!
//! # It comes to rest
//!
//! The answer for a node depends on the maps of its own four corners and on the view, not on the rest of the tree. So
//! while both stand still, a node with bands is never pruned and one without is never expanded. Each node changes at
//! most once, and the tree cannot go back and forth.

use std::collections::HashSet;

/// Subdivisions of a rectangle at most.
pub(super) const LEVELS: u32 = 4;

/// Points along a side: the corners of the smallest quads.
const SIDE: u32 = (1 << LEVELS) + 1;

/// All points of a rectangle, in rows.
pub(super) const POINTS: usize = (SIDE * SIDE) as usize;

/// Nodes that can have children.
pub(super) const INNER: usize = ((1 << (2 * LEVELS)) - 1) / 3;

/// A quad: its level, 0 for the whole rectangle, and its column and row among the quads of its level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Node {
    level: u32,
    x: u32,
    y: u32,
}

impl Node {
    const ROOT: Self = Self { level: 0, x: 0, y: 0 };

    /// Its side, in smallest quads.
    fn side(self) -> u32 {
        1 << (LEVELS - self.level)
    }

    /// Its corners, as indices of points.
    pub(super) fn corners(self) -> [usize; 4] {
        self.grid([0, self.side()]).map(|(x, y)| (y * SIDE + x) as usize)
    }

    /// The points that its four children have and it has not.
    fn inner_points(self) -> [usize; 5] {
        let (half, side) = (self.side() / 2, self.side());
        let (x, y) = (self.x * side, self.y * side);
        [(half, 0), (0, half), (half, half), (side, half), (half, side)]
            .map(|(right, down)| ((y + down) * SIDE + x + right) as usize)
    }

    /// The places of its quad at these steps along both axes, in smallest quads.
    fn grid(self, steps: [u32; 2]) -> [(u32, u32); 4] {
        let (x, y) = (self.x * self.side(), self.y * self.side());
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j): (usize, usize)| (x + steps[i], y + steps[j]))
    }

    fn children(self) -> [Self; 4] {
        let (level, x, y) = (self.level + 1, 2 * self.x, 2 * self.y);
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| Self { level, x: x + i, y: y + j })
    }

    fn parent(self) -> Option<Self> {
        let level = self.level.checked_sub(1)?;
        Some(Self { level, x: self.x / 2, y: self.y / 2 })
    }
}

/// The place of a point on its rectangle, -1 to 1 along each axis.
pub(super) fn place_of(point: usize) -> [f64; 2] {
    let place = |ix: usize| 2.0 * ix as f64 / f64::from(SIDE - 1) - 1.0;
    [place(point % SIDE as usize), place(point / SIDE as usize)]
}

/// The number of points of a rectangle whose quads are all of one level.
pub(super) fn uniform_points(level: u32) -> u32 {
    ((1 << level) + 1_u32).pow(2)
}

/// What a round changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Change {
    pub(super) expanded: u32,
    pub(super) pruned: u32,
    /// Leaves with bands that were not expanded, because their points would exceed the most.
    pub(super) skipped: u32,
}

/// The subdivision of one rectangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Quadtree {
    /// Nodes with children.
    expanded: HashSet<Node>,
    /// Leaves that were leaves in the round before.
    idle: HashSet<Node>,
}

impl Quadtree {
    /// A rectangle whose quads are all of one level.
    pub(super) fn uniform(level: u32) -> Self {
        let mut tree = Self { expanded: HashSet::new(), idle: HashSet::new() };
        for _ in 0..level.min(LEVELS) {
            tree.leaves().into_iter().for_each(|leaf| tree.expand(leaf));
        }
        tree
    }

    /// All nodes, larger quads first.
    fn nodes(&self) -> Vec<Node> {
        let mut nodes = vec![Node::ROOT];
        let mut next = 0;
        while let Some(node) = nodes.get(next) {
            if self.expanded.contains(node) {
                nodes.extend(node.children());
            }
            next += 1;
        }
        nodes
    }

    fn leaves(&self) -> Vec<Node> {
        let mut nodes = self.nodes();
        nodes.retain(|node| !self.expanded.contains(node));
        nodes
    }

    /// The weight of each point; 0 of those that are no corner. They sum to 4 for each smallest quad.
    pub(super) fn weights(&self) -> Vec<u32> {
        let mut weights = vec![0; POINTS];
        for leaf in self.leaves() {
            leaf.corners().into_iter().for_each(|point| weights[point] += leaf.side().pow(2));
        }
        weights
    }

    /// Whether a leaf can be divided with at most so many points in all.
    fn has_room(&self, leaf: Node, weights: &[u32], most: u32) -> bool {
        let is_used = |point: &usize| weights[*point] > 0;
        let used = (0..POINTS).filter(is_used).count() as u32;
        leaf.level < LEVELS
            && used + leaf.inner_points().iter().filter(|point| !is_used(point)).count() as u32
                <= most
    }

    /// Whether some leaf could be divided, had the rectangle more points.
    pub(super) fn is_full(&self, most: u32) -> bool {
        let weights = self.weights();
        let mut leaves = self.leaves().into_iter();
        leaves.any(|leaf| leaf.level < LEVELS && !self.has_room(leaf, &weights, most))
    }

    /// The quads to test, larger ones first: leaves that can be divided, and parents of four idle leaves.
    pub(super) fn tests(&self, most: u32) -> Vec<Node> {
        let weights = self.weights();
        let mut nodes = self.nodes();
        nodes.retain(|node| match self.expanded.contains(node) {
            true => node.children().iter().all(|child| self.idle.contains(child)),
            false => self.has_room(*node, &weights, most),
        });
        nodes
    }

    /// A round: which of the nodes of [`tests`](Self::tests) have bands.
    pub(super) fn refine(&mut self, tested: &[(Node, bool)], most: u32) -> Change {
        let mut change = Change::default();
        let (parents, leaves): (Vec<_>, Vec<_>) =
            tested.iter().partition(|(node, _)| self.expanded.contains(node));
        self.idle = self.leaves().into_iter().collect();
        for (parent, _) in parents.into_iter().filter(|(_, has_bands)| !has_bands) {
            self.prune(parent);
            change.pruned += 1;
        }
        for (leaf, _) in leaves.into_iter().filter(|(_, has_bands)| *has_bands) {
            if leaf.parent().is_some_and(|parent| !self.expanded.contains(&parent)) {
                continue;
            }
            if self.has_room(leaf, &self.weights(), most) {
                self.expand(leaf);
                change.expanded += 1;
            } else {
                change.skipped += 1;
            }
        }
        change
    }

    fn expand(&mut self, leaf: Node) {
        self.idle.remove(&leaf);
        self.expanded.insert(leaf);
    }

    /// Makes a parent of leaves a leaf, which is not idle.
    fn prune(&mut self, parent: Node) {
        parent.children().iter().for_each(|child| {
            self.idle.remove(child);
        });
        self.expanded.remove(&parent);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MAP_COUNTS;

    const ALL: u32 = POINTS as u32;
    /// Four corners of each smallest quad.
    const WHOLE: u32 = 4 << (2 * LEVELS);

    fn points(tree: &Quadtree) -> u32 {
        tree.weights().iter().filter(|weight| **weight > 0).count() as u32
    }

    /// Rounds until nothing changes, with bands where `has_bands` says so.
    fn settle(tree: &mut Quadtree, most: u32, has_bands: impl Fn(Node) -> bool) -> Vec<Change> {
        let mut changes = Vec::new();
        loop {
            let tests = tree.tests(most);
            let tested: Vec<_> = tests.iter().map(|node| (*node, has_bands(*node))).collect();
            changes.push(tree.refine(&tested, most));
            assert_eq!(tree.weights().iter().sum::<u32>(), WHOLE);
            assert!(points(tree) <= most);
            let is_still = changes.last().is_some_and(|c| c.expanded + c.pruned == 0);
            if is_still && tree.tests(most) == tests {
                return changes;
            }
            assert!(changes.len() < 200, "it does not come to rest: {changes:?}");
        }
    }

    #[test]
    fn uniform_trees_have_the_points_and_weights_of_fixed_counts() {
        for (level, count) in (0..).zip(&MAP_COUNTS[1..]) {
            let tree = Quadtree::uniform(level);
            assert_eq!(points(&tree), *count);
            assert_eq!(uniform_points(level), *count);
            let unit = 1 << (2 * (LEVELS - level));
            let weights = tree.weights();
            assert_eq!(weights[0], unit, "a corner of one leaf");
            let middle = weights[POINTS / 2];
            assert_eq!(middle, if level == 0 { 0 } else { 4 * unit });
            assert_eq!(weights.iter().sum::<u32>(), WHOLE);
        }
        assert_eq!(
            (place_of(0), place_of(POINTS / 2), place_of(16)),
            ([-1.0; 2], [0.0; 2], [1.0, -1.0])
        );
    }

    #[test]
    fn neighbours_share_corners_and_pruning_undoes_expanding() {
        let mut tree = Quadtree::uniform(1);
        let before = tree.clone();
        let [first, second, ..] = Node::ROOT.children();
        tree.expand(first);
        assert_eq!(points(&tree), 9 + 5);
        // A quarter of a leaf's area at its own corner, and that of its neighbours where they touch.
        assert_eq!(tree.weights()[0], 16);
        tree.expand(second);
        assert_eq!(points(&tree), 9 + 5 + 4, "one point lies on the edge between them");
        assert_eq!(tree.weights().iter().sum::<u32>(), WHOLE);
        tree.prune(second);
        tree.prune(first);
        assert_eq!(tree, before);
        assert_eq!(tree.weights(), before.weights());
    }

    #[test]
    fn trees_come_to_rest_where_bands_are() {
        // Bands everywhere: all points, and no more than the most.
        for most in [4, 5, 9, 13, 25, 64, 81, ALL] {
            let mut tree = Quadtree::uniform(0);
            settle(&mut tree, most, |_| true);
            assert!(points(&tree) <= most && tree.is_full(most) == (most < ALL), "{most}");
            assert!(points(&tree) + 5 > most, "{} of {most}", points(&tree));
        }
        // None: the corners, from any start, and each round prunes one level.
        for level in 0..=LEVELS {
            let mut tree = Quadtree::uniform(level);
            let changes = settle(&mut tree, ALL, |_| false);
            assert_eq!(points(&tree), 4);
            let pruned: u32 = changes.iter().map(|change| change.pruned).sum();
            assert_eq!(pruned, ((1 << (2 * level)) - 1) / 3);
        }
        // Around one point, from the whole and from a start that is too fine.
        let near = |node: Node| node.level < LEVELS && node.corners().contains(&0);
        let mut trees = [Quadtree::uniform(0), Quadtree::uniform(3)];
        trees.iter_mut().for_each(|tree| drop(settle(tree, ALL, near)));
        assert_eq!(trees[0].weights(), trees[1].weights());
        assert_eq!(points(&trees[0]), 4 + 4 * 5);
        // What appears is expanded, and what disappears is pruned.
        settle(&mut trees[0], ALL, |_| false);
        assert_eq!(points(&trees[0]), 4);
        settle(&mut trees[0], ALL, near);
        assert_eq!(trees[0].weights(), trees[1].weights());
    }

    #[test]
    fn a_round_reports_what_did_not_fit_and_frees_before_it_takes() {
        let mut tree = Quadtree::uniform(1);
        tree.expand(Node::ROOT.children()[0]);
        settle(&mut tree, 14, |node| node.level == 0 || node == Node::ROOT.children()[0]);
        // 14 points of at most 14. The bands move to the opposite quad.
        let (from, to) = (Node::ROOT.children()[0], Node::ROOT.children()[3]);
        let change = tree.refine(&[(from, true), (to, true)], 14);
        assert_eq!(change, Change { expanded: 0, pruned: 0, skipped: 1 });
        let change = tree.refine(&[(from, false), (to, true)], 14);
        assert_eq!(change, Change { expanded: 1, pruned: 1, skipped: 0 });
        assert!(tree.expanded.contains(&to) && points(&tree) == 14);
    }

    #[test]
    fn only_inner_nodes_are_tested() {
        let mut most_tests = 0;
        for level in 0..=LEVELS {
            let mut tree = Quadtree::uniform(level);
            for _ in 0..2 {
                most_tests = most_tests.max(tree.tests(ALL).len());
                tree.refine(&[], ALL);
            }
        }
        assert!(most_tests <= INNER, "{most_tests}");
        // New leaves shield their parent from pruning for one round.
        let mut tree = Quadtree::uniform(1);
        assert_eq!(tree.tests(9), []);
        tree.refine(&[], 9);
        assert_eq!(tree.tests(9), [Node::ROOT]);
    }
}
