//! Plots as pictures: what stands in them, that names can't break out, and that bytes are the same.

use crate::support::desk::{Desk, run_clean};

/// The first colour of series: red, green and blue.
const BLUE: [u8; 3] = [0x00, 0x72, 0xb2];

/// Returns the texts of an SVG file, in order.
fn texts(svg: &str) -> Vec<String> {
    let inside = |line: &str| {
        let from = line.find('>').expect("a tag ends") + 1;
        line[from..line.rfind("</text>").expect("a text ends")].to_string()
    };
    svg.lines().filter(|line| line.starts_with("<text")).map(inside).collect()
}

/// Returns width, height and the pixels of a PNG file, red, green and blue of each.
fn pixels(desk: &Desk, path: &str) -> (usize, usize, Vec<[u8; 3]>) {
    let bytes = &desk.written[path];
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG file");
    let mut pixels = vec![0; reader.output_buffer_size().expect("it fits")];
    let info = reader.next_frame(&mut pixels).expect("a picture");
    let triples = pixels.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    (info.width as usize, info.height as usize, triples)
}

#[test]
fn axes_have_names_units_and_round_ticks() {
    let desk = run_clean(
        "let force = [0N, 5N, 20N]\nlet reach = [0mm, 4mm, 10mm]\n\
         save(plot(force, x: reach, title: \"Pull\"), \"a.svg\")",
    );
    let found = texts(desk.text("a.svg"));
    for wanted in ["0", "2", "10", "20", "reach [mm]", "force [N]", "Pull"] {
        assert!(found.iter().any(|text| text == wanted), "{wanted} in {found:?}");
    }
}

#[test]
fn torques_and_angles_have_their_units() {
    let desk = run_clean(
        "let torque = [-0.3N*m, 0.4N*m]\nlet tilt = [-90deg, 90deg]\nsave(plot(torque, x: tilt), \"a.svg\")",
    );
    let found = texts(desk.text("a.svg"));
    for wanted in ["torque [N·m]", "tilt [deg]", "−90", "30", "−0.2"] {
        assert!(found.iter().any(|text| text == wanted), "{wanted} in {found:?}");
    }
}

#[test]
fn names_can_not_break_out_of_a_plot() {
    let hostile = r#"</svg><script>alert(1)</script>\"'& "#;
    let desk = run_clean(&format!(
        "save(plot([[1, 2], [2, 1]], names: [\"{hostile}\", \"b\"], title: \"{hostile}\", x_label: \"{hostile}\"), \"a.svg\")"
    ));
    let svg = desk.text("a.svg");
    assert!(!svg.contains("<script") && svg.matches("</svg>").count() == 1, "{svg}");
    assert!(svg.contains("&lt;script&gt;alert(1)"), "{svg}");
}

#[test]
fn a_picture_is_the_same_each_time_and_shows_every_point() {
    let text = "save(plot([1, 2, 3, 4], kind: scatter, title: \"ÄΩ<\u{6f22}\"), \"a.png\")";
    let (first, second) = (run_clean(text), run_clean(text));
    assert_eq!(first.written["a.png"], second.written["a.png"]);
    let (width, height, pixels) = pixels(&first, "a.png");
    assert_eq!((width, height), (1440, 900));
    // Four discs of 3.6 pixels of a drawing 960 wide, on a picture half as wide again. Pixels on a rim are mixed.
    let whole = pixels.iter().filter(|pixel| **pixel == BLUE).count() as f64;
    let disc = |radius: f64| 4.0 * std::f64::consts::PI * radius * radius;
    assert!(disc(3.6 * 1.5 - 1.2) < whole && whole < disc(3.6 * 1.5), "{whole}");
}

#[test]
fn a_line_covers_as_many_pixels_as_it_is_long_and_wide() {
    let desk = run_clean("save(plot([1, 1], x: [0, 1]), \"a.png\")");
    let (_, _, pixels) = pixels(&desk, "a.png");
    let svg = run_clean("save(plot([1, 1], x: [0, 1]), \"a.svg\")");
    let line = svg.text("a.svg").lines().find(|line| line.contains("#0072b2")).expect("a line").to_string();
    let from = line.find('"').expect("points") + 1;
    let xs: Vec<f64> = line[from..line[from..].find('"').expect("an end") + from]
        .split(' ')
        .map(|point| point.split_once(',').expect("x,y").0.parse().expect("a number"))
        .collect();
    // Blue takes red away from white; the grid line below is nearly white.
    let ink: f64 =
        pixels.iter().filter(|p| p[2] > p[0].saturating_add(20)).map(|p| f64::from(255 - p[0]) / 255.0).sum();
    let length = (xs[1] - xs[0]) * 1.5;
    assert!((ink / (length * 3.0) - 1.0).abs() < 0.02, "{ink} over {length}");
}

#[test]
fn a_histogram_counts_every_value_once() {
    let desk = run_clean(
        "save(plot([0, 0.5, 1, 1, 2, 3], kind: histogram, bins: 3), \"a.svg\")\n\
         save(plot([x / 7 for x in 0..1000], kind: histogram), \"b.svg\")",
    );
    let svg = desk.text("a.svg");
    // From 0 to 3 in three bins: 0 and 0.5; 1 and 1; 2 and 3. All bars are equally high.
    let bars: Vec<&str> = svg.lines().filter(|line| line.contains("#0072b2")).collect();
    let top = |bar: &str| bar.split([',', ' ']).nth(4).expect("a corner").to_string();
    assert_eq!(bars.len(), 3, "{svg}");
    assert!(bars.iter().all(|bar| top(bar) == top(bars[0])), "{svg}");
    assert!(texts(desk.text("b.svg")).contains(&"number".to_string()));
}

#[test]
fn a_thousand_curves_are_drawn_and_the_legend_says_how_many() {
    let desk = run_clean(
        "let curves = [[sin(1deg * i * n) for i in 0..400] for n in 0..1000]\n\
         save(plot(curves, names: [\"curve {n}\" for n in 0..1000]), \"a.svg\")",
    );
    let svg = desk.text("a.svg");
    let curves =
        svg.lines().filter(|line| line.starts_with("<polyline") && line.contains("stroke-width=\"2\""));
    assert_eq!(curves.count(), 1000);
    assert!(svg.contains("and 984 more") && svg.len() < 8_000_000, "{} bytes", svg.len());
}

#[test]
fn gaps_interrupt_a_curve_and_are_counted() {
    let desk = run_clean("save(plot([1, 2, _, 3, 4, _, 5]), \"a.svg\")");
    let svg = desk.text("a.svg");
    let pieces = svg.lines().filter(|line| line.contains("#0072b2")).count();
    assert_eq!(pieces, 3, "{svg}");
    assert!(svg.contains("not drawn: 2 missing or infinite"));
}
