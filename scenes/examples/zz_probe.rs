//! probe
use std::time::Instant;
fn main() {
    for a in std::env::args().skip(1) {
        let t = Instant::now();
        match scenes::open(&a) {
            Err(e) => println!("{a}: {e}"),
            Ok(s) => {
                println!("{} in {:?}: {} tris, {} meshes {} models {} inst {} mats {} imgs {} lights {} cams\n  bounds {:?}\n core {:?}", s.name, t.elapsed(), s.triangle_count(), s.meshes.len(), s.models.len(), s.instances.len(), s.materials.len(), s.images.len(), s.lights.len(), s.cameras.len(), s.bounds, s.core_bounds);
                for w in s.warnings.iter().take(6) { println!("  ! {w}"); }
                println!("  frame 0 {:?}", s.path.pose(0, 1200));
                let t = Instant::now(); let h = s.hash(); println!("  hash {} {:?}", h, t.elapsed());
                let mut c: Vec<[f32;3]> = s.world_triangles().map(|t| ((t[0]+t[1]+t[2])/3.0).to_array()).collect();
                for ax in 0..3 { c.sort_by(|a,b| a[ax].total_cmp(&b[ax])); let n=c.len(); let q=|f:f32| c[((n-1) as f32*f) as usize][ax]; println!("  axis {ax}: {:?}", [0.0,0.005,0.01,0.02,0.05,0.5,0.95,0.98,0.99,0.995,1.0].map(q)); }
            }
        }
    }
}
