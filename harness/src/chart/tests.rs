//! Charts of awkward data are still well-formed, complete and legible.

use super::*;

/// The elements of an SVG, opened and closed in order, its text without stray markup.
fn assert_well_formed(svg: &str) {
    let mut open = Vec::new();
    let body = svg.strip_prefix("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n").unwrap_or(svg);
    for piece in body.split('<').skip(1) {
        let (tag, text) = piece.split_once('>').expect("a tag ends");
        assert!(!text.contains('>') || open.last() == Some(&"style"), "stray `>` in {text}");
        assert_eq!(tag.matches('"').count() % 2, 0, "an odd quote in {tag}");
        for entity in tag.split('&').chain(text.split('&')).skip(1) {
            let known = ["amp;", "lt;", "gt;", "quot;", "#39;", "#10;"];
            let is_start = tag.starts_with(entity) || text.starts_with(entity);
            assert!(is_start || known.iter().any(|k| entity.starts_with(k)), "&{entity}");
        }
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(tag.split(' ').next().expect("a name"));
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
    assert!(!svg.contains("NaN") && !svg.contains("inf\""), "a number is not finite");
}

fn at(x: f64, y: f64) -> Point {
    Point { x, y, key: "k".into(), tip: "a\nb".into(), label: "l".into(), ..Point::default() }
}

fn chart(scale: Scale, marks: Marks, points: Vec<Point>) -> XyChart {
    let axis = Axis { label: "Time".into(), unit: "ms".into(), scale };
    let series = Series { name: "one".into(), marks, points, ..Series::default() };
    XyChart { title: "T".into(), x: axis.clone(), y: axis, series: vec![series], note: "n".into() }
}

const MARKS: [Marks; 5] =
    [Marks::Points, Marks::Line, Marks::LineAndPoints, Marks::Dashed, Marks::Steps];
const SCALES: [Scale; 3] = [Scale::Linear, Scale::LinearFromZero, Scale::Log];

#[test]
fn awkward_points_give_sound_drawings() {
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let ranged = Point { x_range: Some([nan, 1.0]), y_range: Some([-inf, inf]), ..at(2.0, 3.0) };
    let many = (0..10_000).map(|ix| at(f64::from(ix), f64::from(ix % 97))).collect();
    let sets: [Vec<Point>; 12] = [
        vec![],
        vec![at(nan, 1.0), at(1.0, inf), at(-inf, nan)],
        vec![at(0.0, 0.0)],
        vec![at(5.0, 5.0); 3],
        vec![at(-1.0, -2.0), at(0.0, 0.0)],
        vec![at(-5.0, -5.0)],
        vec![at(1e-300, 1e300), at(f64::MIN_POSITIVE / 8.0, f64::MAX)],
        vec![at(1e-9, 1e-12), at(1e9, 1e12)],
        vec![at(100.0, 100.1), at(100.2, 100.3)],
        vec![at(1e15, 1e15), at(1e15 + 1.0, 1e15 + 1.0)],
        vec![ranged],
        many,
    ];
    for (points, scale) in sets.iter().flat_map(|set| SCALES.map(|scale| (set, scale))) {
        for marks in MARKS {
            let chart = chart(scale, marks, points.clone());
            assert_well_formed(&chart.to_svg());
            if points.len() < 100 {
                assert_well_formed(&chart.to_svg_file());
            }
        }
    }
}

#[test]
fn awkward_bars_and_bins_give_sound_drawings() {
    let values = [f64::NAN, f64::INFINITY, f64::MAX, f64::MAX, 0.0, -1.0, 1e-300];
    let segments = |values: &[f64]| -> Vec<Segment> {
        values.iter().map(|&value| Segment { value, ..Segment::default() }).collect()
    };
    for scale in SCALES {
        for values in [&values[..], &[], &[0.0], &[1.0]] {
            let row =
                BarRow { name: "<&>".repeat(40), segments: segments(values), ..BarRow::default() };
            let axis = Axis { scale, ..Axis::default() };
            let chart =
                BarChart { axis, rows: vec![row, BarRow::default()], ..BarChart::default() };
            assert_well_formed(&chart.to_svg());
            assert_well_formed(&chart.to_svg_file());
        }
    }
    assert_well_formed(&BarChart::default().to_svg());
    let bins = |count: u64| Histogram {
        title: "\"q\" & <b>".repeat(20),
        bins: (0..count).map(|bin| (format!("> {bin}"), bin * (u64::MAX / 400))).collect(),
        ..Histogram::default()
    };
    assert_well_formed(&histograms_svg("", &[]));
    assert_well_formed(&histograms_svg_file("<", &[bins(0), bins(1), bins(400)]));
    assert_well_formed(&bins(3).to_svg());
}

#[test]
fn strips_place_samples_by_their_distance_from_the_median() {
    let strip = |samples: &[f64]| Strip {
        title: "<a> & b".into(),
        samples: samples.to_vec(),
        median: 10.0,
        half_width: 0.1,
        ..Strip::default()
    };
    let all = strip(&[9.0, 10.0, 10.000_1, 10.5, 20.0, f64::NAN, f64::INFINITY]);
    let svg = all.to_svg();
    assert_well_formed(&svg);
    // The ends are 490 units from the middle; ticks less than a unit apart are drawn once.
    assert!(svg.contains("d=\"M10 4V20M500 4V20M745 4V20\""), "{svg}");
    assert_eq!(all.beyond(), 1);
    assert_eq!(half_width([&strip(&[9.0, 10.5])]), 0.1);
    assert_eq!(half_width([&strip(&[10.0]), &strip(&[10.21])]), 0.03);
    assert_eq!(half_width([&all]), 1.0);
    let empty = Strip::default();
    assert_well_formed(&empty.to_svg());
    assert_eq!((empty.beyond(), half_width([&empty])), (0, 0.01));
}

#[test]
fn names_are_text_and_whole_in_their_tips() {
    let name = "a <b> & \"c\" 'd' ".repeat(12);
    for marks in MARKS {
        let mut chart = chart(Scale::Linear, marks, vec![at(1.0, 1.0), at(2.0, 2.0)]);
        chart.title.clone_from(&name);
        chart.note.clone_from(&name);
        chart.x.label.clone_from(&name);
        for series in &mut chart.series {
            series.name.clone_from(&name);
            series.class = "x\" onload=\"y".into();
        }
        let svg = chart.to_svg();
        assert_well_formed(&svg);
        assert_well_formed(&chart.to_svg_file());
        assert!(svg.contains(&format!("<title>{}</title>", text::escape(name.trim()))));
        assert!(!svg.contains("<b>") && !svg.contains("onload=\""));
    }
    let svg = chart(Scale::Linear, Marks::Points, vec![at(1.0, 1.0)]).to_svg();
    assert!(svg.contains(
        "<g data-key=\"k\" tabindex=\"0\" role=\"button\" aria-label=\"a, b\"><title>a&#10;b</title>"
    ));
}

#[test]
fn exact_zeros_have_a_lane_on_logarithmic_axes_only() {
    let points = vec![at(1.0, 0.0), at(10.0, 0.5), at(20.0, -1.0), at(f64::NAN, 0.1)];
    let svg = chart(Scale::Log, Marks::Points, points.clone()).to_svg();
    assert!(svg.contains("class=\"lane\"") && svg.contains(">0</text>"));
    assert!(svg.contains("1 point is below zero.") && svg.contains("1 point is not finite."));
    assert_eq!(svg.matches("class=\"hit\"").count(), 2);
    assert!(!chart(Scale::Linear, Marks::Points, points).to_svg().contains("class=\"lane\""));
}

#[test]
fn long_lines_keep_their_spikes_and_stay_small() {
    let frames = |offset: f64| {
        let height = move |frame: i32| {
            if frame == 777 { 90.0 } else { offset + (f64::from(frame) * 0.7).sin() }
        };
        (0..1200).map(|frame| at(f64::from(frame), height(frame))).collect::<Vec<Point>>()
    };
    let mut chart = chart(Scale::LinearFromZero, Marks::Line, vec![]);
    chart.series = (0..10)
        .map(|ix| Series {
            name: format!("s{ix}"),
            marks: Marks::Line,
            points: frames(f64::from(ix)),
            ..Series::default()
        })
        .collect();
    let svg = chart.to_svg();
    assert!(svg.len() < 200_000, "{} bytes", svg.len());
    let line: Vec<reduce::Place> = (0..5000)
        .map(|ix| [f64::from(ix) * 0.1, if ix == 3210 { -50.0 } else { f64::from(ix % 3) }])
        .collect();
    let reduced = reduce::by_column(&line);
    assert!(reduced.len() <= 1000 && reduced.contains(&[321.0, -50.0]));
    assert!(reduced.is_sorted_by(|a, b| a[0] <= b[0]));
}

/// Where each text of a drawing is: its box, with the widths that the layout assumes.
fn boxes(svg: &str) -> Vec<(String, occupancy::Area)> {
    let value = |tag: &str, name: &str| -> Option<f64> {
        tag.split(&format!("{name}=\"")).nth(1)?.split('"').next()?.parse().ok()
    };
    svg.split("<text")
        .skip(1)
        .filter_map(|piece| {
            let (tag, rest) = piece.split_once('>')?;
            let text = rest.split('<').next()?.replace("&gt;", ">");
            let (x, y, width) = (value(tag, " x")?, value(tag, " y")?, text::width(&text));
            let left = match tag {
                _ if tag.contains("\"middle\"") => x - width * 0.5,
                _ if tag.contains("\"end\"") => x - width,
                _ => x,
            };
            let area =
                occupancy::Area { left, top: y - 11.0, right: left + width, bottom: y + 2.0 };
            Some((text, area))
        })
        .collect()
}

#[test]
fn labels_of_a_crowd_do_not_overlap() {
    for (marks, scale) in MARKS.into_iter().flat_map(|m| SCALES.map(|s| (m, s))) {
        let mut chart = chart(scale, marks, vec![]);
        chart.series = (0..9)
            .map(|ix| {
                let place = |step: u32| Point {
                    label: format!("p{step}"),
                    ..at(f64::from(ix * step) * 1e-5, f64::from((ix * 7 + step * 5) % 11))
                };
                Series {
                    name: format!("strategy {ix}"),
                    marks,
                    points: (0..12).map(place).collect(),
                    ..Series::default()
                }
            })
            .collect();
        let boxes = boxes(&chart.to_svg());
        assert!(boxes.len() > 15);
        for (ix, (text, a)) in boxes.iter().enumerate() {
            assert!(a.left >= -0.5 && a.right <= canvas::WIDTH + 0.5, "{text} leaves the drawing");
            for (other, b) in boxes.iter().skip(ix + 1) {
                let apart = a.right <= b.left
                    || b.right <= a.left
                    || a.bottom <= b.top
                    || b.bottom <= a.top;
                assert!(apart, "{text} overlaps {other}: {marks:?}, {scale:?}");
            }
        }
    }
}

#[test]
fn ticks_are_round_and_written_plainly() {
    let texts = |ticks: Vec<ticks::Tick>| -> Vec<String> {
        ticks.iter().map(|tick| number::plain(tick.value)).collect()
    };
    assert_eq!(texts(ticks::linear(0.0, 1.0, 5)), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
    assert_eq!(texts(ticks::log(0.9, 30.0, 6)), ["1", "2", "5", "10", "20"]);
    assert_eq!(texts(ticks::log(1e-7, 1e3, 6)), ["1e-6", "0.0001", "0.01", "1", "100"]);
    assert_eq!(number::plain(1_000.0), "1,000");
}

#[test]
fn files_bring_their_colours() {
    let file = chart(Scale::Log, Marks::Line, vec![at(1.0, 1.0)]).to_svg_file();
    assert!(file.starts_with("<?xml") && file.contains("prefers-color-scheme: dark"));
    assert!(!file.contains("var(") && file.contains("<title>T</title>"));
}

#[test]
fn series_of_one_shape_and_class_share_a_row_of_zeros() {
    let height = |shapes: [Option<usize>; 2]| {
        let mut chart = chart(Scale::Log, Marks::Points, vec![at(1.0, 0.0), at(2.0, 1.0)]);
        let first = chart.series.pop().expect("a series");
        chart.series = shapes.map(|shape| Series { shape, ..first.clone() }).to_vec();
        let svg = chart.to_svg();
        let size = svg.split("viewBox=\"").nth(1).and_then(|rest| rest.split('"').next());
        size.and_then(|size| size.split(' ').nth(3)?.parse::<f64>().ok()).expect("a height")
    };
    assert_eq!(height([None, None]), height([Some(0), Some(1)]));
    assert!(height([Some(0), Some(0)]) < height([Some(0), Some(1)]));
}

/// Where the points of a drawing are: middle of each mark that can be hit.
fn places(svg: &str) -> Vec<[f64; 2]> {
    let number = |tag: &str, name: &str| -> f64 {
        let value = tag.split(&format!(" {name}=\"")).nth(1).and_then(|v| v.split('"').next());
        value.and_then(|v| v.parse().ok()).expect("a number")
    };
    let marks = svg.split("<circle").skip(1).filter_map(|piece| piece.split('>').next());
    let hit = marks.filter(|tag| tag.contains("class=\"hit\""));
    hit.map(|tag| [number(tag, "cx"), number(tag, "cy")]).collect()
}

#[test]
fn points_lie_where_the_axes_say() {
    let steps = |values: [f64; 3]| values.map(|value| at(value, value)).to_vec();
    for (scale, values) in [
        (Scale::Linear, [10.0, 20.0, 30.0]),
        (Scale::LinearFromZero, [10.0, 20.0, 30.0]),
        (Scale::Log, [1.0, 10.0, 100.0]),
    ] {
        let places = places(&chart(scale, Marks::Points, steps(values)).to_svg());
        let [a, b, c] = places[..] else { panic!("{scale:?}: {places:?}") };
        // To the right and upwards, in equal steps.
        assert!(a[0] + 20.0 < b[0] && a[1] - 20.0 > b[1], "{scale:?}: {places:?}");
        for axis in [0, 1] {
            let (first, second) = (b[axis] - a[axis], c[axis] - b[axis]);
            assert!((first - second).abs() < 0.5, "{scale:?}: {places:?}");
        }
    }
    // Of values in other steps places are in other steps.
    let uneven = places(&chart(Scale::Linear, Marks::Points, steps([10.0, 11.0, 30.0])).to_svg());
    assert!((uneven[1][0] - uneven[0][0]) * 10.0 < uneven[2][0] - uneven[1][0], "{uneven:?}");
}
