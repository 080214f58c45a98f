//! The jobs of a scene, without a device.

use super::*;

fn plan(quick: bool, triangles: u64) -> Vec<Job> {
    let scene = StudyScene { scene: "atrium".into(), name: "atrium".into(), scale: 1.0 };
    let extent = Extent::new(quick, triangles);
    let mut plan = Plan { scene: &scene, extent, seed: 1, jobs: Vec::new() };
    plan.example();
    plan.searches();
    plan.views(Some(Views { low: 3, high: 7, count: 60 }));
    plan.rankings();
    plan.scaling();
    plan.beyond();
    plan.accuracy();
    plan.jobs
}

#[test]
fn every_command_is_understood() {
    for (quick, triangles) in [(false, 1_000), (false, 7_000_000), (true, 1_000)] {
        let jobs = plan(quick, triangles);
        for job in &jobs {
            let parsed = crate::cli::parse(&job.command);
            let Ok(Invocation::Compare(args)) = parsed else {
                panic!("{}: {:?}", job.name, parsed.err());
            };
            args.choices().unwrap_or_else(|error| panic!("{}: {error}", job.name));
        }
        let mut names: Vec<&str> = jobs.iter().map(|job| job.name.as_str()).collect();
        names.sort_unstable();
        let count = names.len();
        names.dedup();
        assert_eq!(names.len(), count, "names of jobs are unique");
    }
}

/// Searches, scaling and rankings are means along the path, over laps enough to tell ties.
#[test]
fn what_ranks_is_measured_along_the_path() {
    for triangles in [1_000, 7_000_000] {
        let jobs = plan(false, triangles);
        for section in ["sizes", "tests", "path", "scaling"] {
            let chosen: Vec<&Job> = jobs.iter().filter(|job| job.section == section).collect();
            assert!(!chosen.is_empty(), "{section}");
            for job in chosen {
                assert!(job.command.iter().any(|word| word == "--path"), "{}", job.name);
                let laps: u32 = job.option("--laps").and_then(|n| n.parse().ok()).expect("laps");
                assert!(laps >= 6, "{}: {laps} laps", job.name);
            }
        }
    }
    let jobs = plan(false, 1_000);
    let poses = |name: &str| -> u32 {
        let job = jobs.iter().find(|job| job.name == name).expect("a job");
        job.option("--frames").and_then(|n| n.parse().ok()).expect("frames")
    };
    assert_eq!((poses("atrium-path-10000"), poses("atrium-sizes-SC-E")), (240, 24));
    assert_eq!((poses("atrium-scaling-1000"), poses("atrium-tests-T-E")), (24, 24));
}

/// Sizes for the paper's claims come from the list of all lights, those of bvh rows through it.
#[test]
fn sizes_are_searched_from_the_source_that_they_are_reported_for() {
    let jobs = plan(false, 1_000);
    for job in jobs.iter().filter(|job| job.section == "sizes") {
        let ids = job.option("--strategies").expect("strategies");
        let is_bvh = job.name.ends_with("-bvh");
        assert!(ids.split(',').all(|id| id.ends_with("/bvh") == is_bvh), "{}: {ids}", job.name);
        assert!(job.option("--source").is_none(), "{}", job.name);
    }
}

/// A family of tests, which has a row and nothing else, takes part where its role and its sizes say so.
#[test]
fn a_family_joins_by_its_row() {
    let jobs = plan(false, 1_000);
    let strategies = |jobs: &[Job], name: &str| -> String {
        let job = jobs.iter().find(|job| job.name == name).expect(name);
        job.option("--strategies").expect(name).to_owned()
    };
    let searched = strategies(&jobs, "atrium-sizes-Made-Up");
    assert_eq!(searched, "Made-Up/5,Made-Up/7,Made-Up/9");
    for name in ["atrium-main-10000", "atrium-views-low", "atrium-path-10000"] {
        let ids = strategies(&jobs, name);
        assert!(ids.split(',').any(|id| id == "Made-Up/7"), "{name}: {ids}");
    }
    // Heavy scenes see the comparison paper's strategies only.
    let heavy = plan(false, 7_000_000);
    assert!(heavy.iter().all(|job| !job.command.join(" ").contains("Made-Up")));
}
