//! Bit masks whose words the lanes of a subgroup read together: a bit per light and tile, scalarised.
//!
//! The masks are those of `masks.rs`, and the culling kernel writes them in the same way. Only the look-up differs.
//! Pixels of one subgroup may belong to different groups, and then read different lights at the same time. Each
//! load then fetches several lights, and lanes with short masks wait for lanes with long ones. Here, the lanes join
//! their words first. All of them then evaluate the lights of the union, one after the other: the same light in
//! the same step.
//!
//! Drobot 2017, "Improved Culling for Tiled and Clustered Rendering", SIGGRAPH Advances in Real-Time Rendering
//! (scalarised words of Call of Duty: Infinite Warfare).
//!
//! # Phases of the look-up
//!
//! 1. Each lane finds the next node of 64 lights in which its own mask has a bit. The subgroup takes the first of
//!    these nodes.
//! 2. The lanes that want this node join their words with a subgroup OR.
//! 3. Each lane takes the joined words, also one that wants a later node. It evaluates their lights, and then goes
//!    back to phase 1.
//!
//! A lane that has read all lights of its own mask leaves the loop. Lanes may also diverge for other reasons, which
//! the look-up does not control. So the lanes that run together form a new team at each node (`look_up_mask.wesl`). A
//! lane that is already past a node waits for those that are not. So each lane reads every light of its own mask
//! once, in ascending order, whichever lanes run with it.
//!
//! Worked example: the masks of lanes A and B hold lights 1 and 70, and light 3. Both want node 0, and join its bits:
//! both evaluate lights 1 and 3. B has read its only light. A reads node 1 alone, and evaluates light 70.
//!
//! A lane evaluates lights that are not in its own mask. These add exactly 0, because a mask holds every light that
//! reaches one of its group's samples. So the image stays the same in every bit. Skipping such lights inside the
//! look-up would send its lanes different ways at every light, and undo what the union is for. The early exit of
//! shading leaves them out after one distance.
//!
//! # Cost
//!
//! - Memory and culling: those of `/mask`.
//! - Shading: one minimum, two ORs and two votes of the subgroup for each node that its lanes read. Where a subgroup
//!   has pixels of several groups, each pixel also evaluates lights of the other groups. In the atrium with 500
//!   lights at 320x180, with subgroups of 8 pixels, a sample evaluates 11.4 lights in place of 10.6 with
//!   `T-E/28x28`, and 7.4 in place of 5.6 with `SC-E/48x48x40/bvh`.
//!
//! # Where it fails
//!
//! - With small groups, such as clusters, a subgroup crosses several of them. It evaluates the lights of all.
//! - Where all lanes are of one group, the plain mask already reads the same words in each lane.
//! - It needs `wgpu::Features::SUBGROUP`. Fragment shaders read plain masks.

#[cfg(test)]
mod tests {
    /// Reads masks as the look-up does, and returns the lights that each lane evaluates, in order. `running` tells
    /// which lanes run in a round.
    fn read(masks: &[&[u32]], running: impl Fn(usize, usize) -> bool) -> Vec<Vec<u32>> {
        let mut unread: Vec<Vec<u32>> = masks.iter().map(|mask| mask.to_vec()).collect();
        let mut next_node = vec![0; masks.len()];
        let mut found = vec![Vec::new(); masks.len()];
        for round in 0.. {
            if unread.iter().all(Vec::is_empty) {
                break;
            }
            let is_running = |lane: &usize| running(round, *lane) && !unread[*lane].is_empty();
            let team: Vec<usize> = (0..masks.len()).filter(is_running).collect();
            let Some(node) = team.iter().map(|&lane| unread[lane][0] / 64).min() else { continue };
            let of_node = |light: &&u32| **light / 64 == node;
            let mut union: Vec<u32> = team
                .iter()
                .flat_map(|&lane| unread[lane].iter().filter(of_node))
                .copied()
                .collect();
            union.sort_unstable();
            union.dedup();
            for lane in team {
                if node < next_node[lane] {
                    continue;
                }
                next_node[lane] = node + 1;
                found[lane].extend(&union);
                unread[lane].retain(|light| light / 64 != node);
            }
        }
        found
    }

    #[test]
    fn the_worked_example() {
        assert_eq!(read(&[&[1, 70], &[3]], |_, _| true), [&[1, 3, 70][..], &[1, 3]]);
    }

    #[test]
    fn lanes_read_all_their_lights_once_and_in_order_whichever_run() {
        let masks: [&[u32]; 4] = [&[1, 70, 200], &[3, 64, 65, 300], &[5], &[0, 127, 128, 129, 511]];
        for seed in 1..200_u64 {
            let bits =
                |round: usize| (seed * (round as u64 + 1)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let found = read(&masks, |round, lane| bits(round) >> (40 + lane) & 1 == 1);
            for (mask, found) in masks.iter().zip(&found) {
                assert!(found.is_sorted_by(|a, b| a < b), "{found:?}");
                assert!(mask.iter().all(|light| found.contains(light)), "{mask:?} in {found:?}");
            }
        }
    }
}
