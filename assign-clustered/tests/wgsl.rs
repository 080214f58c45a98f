//! The kernels link and validate, without a GPU.
use assign::{Culler, FrustumTests, GroupShape};
#[test]
fn kernel_links_and_validates() {
    for spots in [false, true] {
        for sat_n in [false, true] {
            let shape = GroupShape::Frustum(FrustumTests { sat_n });
            let wgsl =
                Culler::kernel_source(shape, assign_clustered::DENSE_IMPLICIT_WESL, spots).unwrap();
            if std::env::var("SHOW").is_ok() {
                println!("{wgsl}");
            }
            let module = naga::front::wgsl::parse_str(&wgsl)
                .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&wgsl)));
            naga::valid::Validator::new(
                naga::valid::ValidationFlags::all(),
                naga::valid::Capabilities::default(),
            )
            .validate(&module)
            .unwrap_or_else(|e| panic!("{}", e.emit_to_string(&wgsl)));
        }
    }
}
