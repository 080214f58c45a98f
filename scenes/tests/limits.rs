//! Tests of files that ask for a lot in few bytes: they are refused, or drawn within seconds.

mod made_up;

use std::{fs, process::Command, time::Instant};

use made_up::{MadeUp, floats, load_file, png, png_header};
use serde_json::json;

/// Seconds. Each of these files takes less now, and took more before its cost was bounded.
const SECONDS: f64 = 30.0;

#[track_caller]
fn within_seconds<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    let seconds = start.elapsed().as_secs_f64();
    println!("{what}: {seconds:.2} s");
    assert!(seconds < SECONDS, "{what}: {seconds} s");
    result
}

#[test]
fn pixels_are_counted_by_headers_before_any_is_decoded() {
    // One source 12 times, and 12 sources.
    for shared in [true, false] {
        let mut file = MadeUp::triangle();
        let mut view = file.view(&png_header(16_384, 16_384));
        for _ in 0..12 {
            if !shared {
                view = file.view(&png_header(16_384, 16_384));
            }
            file.textured(json!({"bufferView": view, "mimeType": "image/png"}));
        }
        let error = file.error();
        assert!(error.contains("pixels of all 12 images in use"), "{error}");
        assert!(error.contains("is 3221225472: it must be at most"), "{error}");
    }
    for (width, height, expected) in [
        (16_385, 1, "images[0] size is 16385 x 1: it must be at most 16384 pixels"),
        (1, u32::MAX >> 1, "images[0]"),
        (0, 4, "images[0] does not decode"),
        (16_384, 16_384, "images[0] does not decode"),
    ] {
        let mut file = MadeUp::triangle();
        let view = file.view(&png_header(width, height));
        file.textured(json!({"bufferView": view}));
        let error = file.error();
        assert!(error.contains(expected) && !error.contains('\n'), "{error}");
    }
}

#[test]
fn equal_sources_are_decoded_once() {
    let mut file = MadeUp::triangle();
    let view = file.view(&png());
    let mut alias = file.json["bufferViews"][view].clone();
    alias["name"] = "the same bytes".into();
    let alias = file.push("bufferViews", alias);
    let other = file.view(&png());
    for view in [view, view, alias, other] {
        file.textured(json!({"bufferView": view, "mimeType": "image/png"}));
    }
    let scene = file.load().expect("valid");
    let used: Vec<_> = scene.materials.iter().filter_map(|m| m.base_color_texture).collect();
    let used: Vec<u32> = used.iter().map(|texture| texture.image).collect();
    assert_eq!((scene.images.len(), used), (2, vec![0, 0, 0, 1]));
    // The same bytes as colours and as numbers give two images of one source.
    let texture = json!({"index": 0});
    file.json["materials"][1]["normalTexture"] = texture;
    let scene = file.load().expect("valid");
    assert_eq!(scene.images.len(), 3);
    assert!(scene.images.iter().all(|image| image.rgba == scene.images[0].rgba));
}

#[test]
fn images_cut_short_are_refused_or_named() {
    let encoded = |format| {
        let pixel = |x: u32, y: u32| image::Rgb([x * 7, y * 5, x * y].map(|v| v as u8));
        let mut bytes = std::io::Cursor::new(Vec::new());
        let image = image::RgbImage::from_fn(64, 64, pixel);
        image.write_to(&mut bytes, format).expect("encodes");
        bytes.into_inner()
    };
    let load = |bytes: &[u8]| {
        let mut file = MadeUp::triangle();
        let view = file.view(bytes);
        file.textured(json!({"bufferView": view}));
        file.load().map_err(|error| error.to_string())
    };
    for format in [image::ImageFormat::Png, image::ImageFormat::Jpeg] {
        let whole = encoded(format);
        assert!(load(&whole).is_ok_and(|scene| scene.warnings.is_empty()), "{format:?}");
        for end in [0, 1, 9, 40, whole.len() / 2, whole.len() - 20] {
            let says = match load(&whole[..end]) {
                Ok(scene) => scene.warnings.join("; "),
                Err(error) => error,
            };
            let named = says.contains("images[0]\" is a truncated JPEG")
                || says.contains("images[0] does not decode")
                || says.contains("bufferViews");
            assert!(named, "{format:?} {end}: {says}");
        }
    }
}

/// The triangle as `.gltf` with its buffer in a file of that name; everything in `folder`.
fn with_buffer(folder: &std::path::Path, uri: &str) -> Result<scenes::Scene, String> {
    let mut file = MadeUp::triangle();
    file.json["buffers"][0]["uri"] = uri.into();
    load_file(&folder.join("scene.gltf"), file.json.to_string().as_bytes())
        .map_err(|error| error.to_string())
}

#[cfg(unix)]
#[test]
fn buffers_are_read_from_regular_files_and_no_further_than_their_length() {
    let root = tempfile::tempdir().expect("a temporary folder");
    let folder = root.path().join("scene");
    fs::create_dir_all(folder.join("sub")).expect("creates");
    let bytes = MadeUp::triangle().binary;
    let write = |name: &str| fs::write(folder.join(name), &bytes).expect("writes");
    write("plain.bin");
    write("sub/data.bin");
    fs::write(root.path().join("beside.bin"), &bytes).expect("writes");
    let huge = fs::File::create(folder.join("huge.bin")).expect("creates");
    huge.set_len(3 << 30).expect("a file of holes");
    std::os::unix::fs::symlink("/dev/zero", folder.join("zero.bin")).expect("links");
    std::os::unix::fs::symlink("../beside.bin", folder.join("link.bin")).expect("links");
    std::os::unix::fs::symlink("plain.bin", folder.join("near.bin")).expect("links");
    let made = Command::new("mkfifo").arg(folder.join("pipe.bin")).status();
    assert!(made.is_ok_and(|status| status.success()), "mkfifo");
    within_seconds("parts", || {
        for name in ["plain.bin", "sub/data.bin", "sub/../plain.bin", "near.bin"] {
            let scene = with_buffer(&folder, name).expect(name);
            assert!(scene.warnings.is_empty(), "{name}: {:?}", scene.warnings);
        }
        // A triangle of zeros.
        let scene = with_buffer(&folder, "huge.bin");
        assert!(scene.as_ref().is_ok_and(|s| s.triangle_count() == 1), "{:?}", scene.err());
        for name in ["zero.bin", "pipe.bin", "sub"] {
            let error = with_buffer(&folder, name).expect_err(name);
            let expected = format!("{name}, which cannot be read: it is not a regular file");
            assert!(
                error.contains("buffers[0].uri names ") && error.contains(&expected),
                "{error}"
            );
        }
        for name in ["../beside.bin", "link.bin", "sub/../../beside.bin"] {
            let scene = with_buffer(&folder, name).expect(name);
            let expected = format!("buffers[0].uri {name:?} lies outside the scene's folder: ");
            assert!(scene.warnings[0].starts_with(&expected), "{:?}", scene.warnings);
        }
        let absolute = root.path().join("beside.bin").display().to_string();
        for name in [&absolute, "/dev/zero", "C:\\x.bin", "%2Fdev%2Fzero", "file:///dev/zero"] {
            let error = with_buffer(&folder, name).expect_err(name);
            assert!(error.contains("a data URI or a relative path"), "{error}");
        }
    });
}

/// A file of a few hundred bytes. Its one sparse accessor makes triangles of zeros and one other
/// corner.
fn sparse_triangles(vertices: usize) -> MadeUp {
    let mut file = MadeUp::triangle();
    let at = file.view(&[1, 0, 0, 0]);
    let with = file.view(&floats(&[1.0, 0.0, 0.0]));
    let accessor = file.push(
        "accessors",
        json!({"componentType": 5126, "count": vertices, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 0, 0], "sparse": {"count": 1,
            "indices": {"bufferView": at, "componentType": 5125}, "values": {"bufferView": with}}}),
    );
    file.json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": accessor}});
    file
}

/// The triangle `count` times, by indices of one byte.
fn repeated(count: usize) -> MadeUp {
    let mut file = MadeUp::triangle();
    let indices = file.accessor(&[0, 1, 2].repeat(count), 3 * count, 5121, "SCALAR");
    file.json["meshes"][0]["primitives"][0]["indices"] = indices.into();
    file
}

#[test]
fn triangles_without_area_and_coincident_ones_take_seconds() {
    let error = within_seconds("without area", || sparse_triangles(1_200_000).error());
    assert!(error.contains("scene has 0 triangles"), "{error}");
    let scene = within_seconds("repeated", || repeated(400_000).load()).expect("drawn");
    assert_eq!(scene.triangle_count(), 1);
    let expected = "399999 of 400000 triangles repeat another triangle and are left out";
    assert!(scene.warnings[0].contains(expected), "{:?}", scene.warnings);
    // With a normal map, tangents are computed for them.
    let mut mapped = repeated(400_000);
    let view = mapped.view(&png());
    mapped.textured(json!({"bufferView": view}));
    mapped.json["materials"][0]["normalTexture"] = json!({"index": 0});
    within_seconds("repeated, with tangents", || mapped.load()).expect("drawn");
    let placed = |count: usize, at: &dyn Fn(usize) -> serde_json::Value| {
        let mut file = MadeUp::triangle();
        file.json["nodes"] = (0..count).map(at).collect();
        file.json["scenes"][0]["nodes"] = (0..count).collect();
        file
    };
    let piled = placed(200_000, &|_| json!({"mesh": 0}));
    let scene = within_seconds("placed", || piled.load()).expect("drawn");
    assert_eq!(scene.triangle_count(), 200_000);
    let row = placed(50_000, &|ix| json!({"mesh": 0, "translation": [ix, 0, 0]}));
    within_seconds("placed in a row", || row.load()).expect("drawn");
}

#[test]
fn accessors_do_not_expand_beyond_what_is_allowed() {
    let one = sparse_triangles(1 << 21);
    for count in [3, 400] {
        let mut file = one.clone();
        let primitive = file.json["meshes"][0]["primitives"][0].clone();
        file.json["meshes"][0]["primitives"] = (0..count).map(|_| primitive.clone()).collect();
        let error = within_seconds("sparse", || file.error());
        assert!(error.contains("at most "), "{error}");
    }
    for count in [1_u64 << 25, u64::from(u32::MAX), u64::MAX] {
        let mut file = one.clone();
        file.json["accessors"][4]["count"] = count.into();
        let error = within_seconds("one", || file.error());
        assert!(error.contains("at most ") || error.contains("1 to 4294967295"), "{error}");
    }
    let lists = ["nodes", "materials", "textures", "images", "cameras", "buffers"];
    for list in lists {
        let mut file = MadeUp::triangle();
        file.json[list] = (0..=1 << 21).map(|_| json!({})).collect();
        let error = within_seconds(list, || file.error());
        assert!(error.contains(&format!("{list} count is 2097153: it must be at most")), "{error}");
    }
}

#[test]
fn warnings_and_names_stay_short_and_few() {
    let mut file = MadeUp::triangle();
    let point = json!({"attributes": {"POSITION": 0}, "mode": 0});
    let triangle = file.json["meshes"][0]["primitives"][0].clone();
    file.json["meshes"][0]["primitives"] = (0..80_000).map(|_| point.clone()).collect();
    file.json["meshes"][0]["primitives"][7] = triangle;
    file.json["meshes"][0]["name"] = "short".into();
    let scene = within_seconds("many", || file.load()).expect("valid");
    assert_eq!(scene.warnings.len(), 21);
    assert_eq!(scene.warnings[0], "mesh \"short.0\": primitives of type Points are not drawn");
    assert_eq!(scene.warnings[20], "and 79,979 more like the last one");
    file.json["meshes"][0]["name"] = "long \u{1b}[31m\u{202e}\n".repeat(200_000).into();
    let scene = within_seconds("long", || file.load()).expect("valid");
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    assert!(scene.warnings[0].starts_with("mesh \"long \\u{1b}[31m\\u{202e}\\nlong"));
    assert!(scene.warnings[0].chars().count() < 200, "{:?}", scene.warnings);
    assert!(scene.meshes[0].name.chars().count() < 200);
}

#[test]
fn deep_trees_with_cameras_everywhere_take_seconds() {
    const DEPTH: usize = 100_000;
    let mut file = MadeUp::triangle();
    file.push(
        "cameras",
        json!({"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1},
        "name": "long ".repeat(100_000)}),
    );
    let keys = file.accessor(&floats(&[0.0, 1.0]), 2, 5126, "SCALAR");
    let values = file.accessor(&floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]), 2, 5126, "VEC3");
    let nodes = (0..DEPTH).map(|ix| json!({"camera": 0, "children": [ix + 1]}));
    file.json["nodes"] = nodes.chain([json!({"mesh": 0})]).collect();
    file.json["animations"] = json!([{
        "samplers": [{"input": keys, "output": values}],
        "channels": (0..10_000).map(|_| json!({"sampler": 0,
            "target": {"node": DEPTH, "path": "translation"}})).collect::<Vec<_>>(),
    }]);
    let scene = within_seconds("deep", || file.load()).expect("valid");
    assert_eq!((scene.triangle_count(), scene.cameras.len()), (1, DEPTH));
    file.json["nodes"][DEPTH] = json!({"mesh": 0, "children": [5]});
    let error = within_seconds("cycle", || file.error());
    assert!(error.contains("reached twice"), "{error}");
}
