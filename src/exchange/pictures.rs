//! Plans as moving pictures: GIF, and numbered pictures in PNG.

use super::export::{Export, ExportFile};
use super::refusal::Refusal;
use crate::plan::Plan;
use crate::view::{self, RenderInput, StillOptions};

/// The pictures a second.
const RATE: f64 = 10.0;
/// The greatest number of pictures: those of longer plans are further apart.
const FRAMES_MAX: usize = 120;

/// Returns the times of the pictures, s, and how long each is shown, in hundredths of a second.
fn times(plan: &Plan) -> (Vec<f64>, u16) {
    let duration = plan.body.duration();
    let steps = ((duration * RATE).ceil() as usize).clamp(1, FRAMES_MAX - 1);
    let times = (0..=steps).map(|k| duration * k as f64 / steps as f64).collect();
    let shown = libm::round(100.0 * duration / steps as f64).clamp(2.0, 6000.0) as u16;
    if duration == 0.0 { (vec![0.0], shown) } else { (times, shown) }
}

fn drawn(export: &Export, times: &[f64], see: &mut dyn FnMut(Vec<[u8; 3]>, Vec<u8>)) {
    let input = RenderInput { title: export.title, plan: export.plan, texts: &[], command: "" };
    let (width, height) = export.picture_size;
    let options = StillOptions { width: width.into(), height: height.into(), ..StillOptions::default() };
    view::frames(&input, &options, times, see);
}

/// Returns a plan as a GIF that repeats.
///
/// # Errors
/// None: every plan has pictures.
pub(super) fn write_gif(export: &Export) -> Result<Vec<ExportFile>, Refusal> {
    let (times, shown) = times(export.plan);
    let (width, height) = export.picture_size;
    let mut bytes = Vec::new();
    let mut encoder = gif::Encoder::new(&mut bytes, width, height, &[]).expect("memory takes all bytes");
    encoder.set_repeat(gif::Repeat::Infinite).expect("memory takes all bytes");
    drawn(export, &times, &mut |colours, pixels| {
        let palette = colours.as_flattened();
        let mut frame = gif::Frame::from_palette_pixels(width, height, pixels, palette, None);
        frame.delay = shown;
        encoder.write_frame(&frame).expect("memory takes all bytes");
    });
    drop(encoder);
    Ok(vec![ExportFile { name: format!("{}.gif", export.stem), bytes }])
}

/// Returns a plan as pictures in PNG in the folder `STEM.frames`, numbered from 0001.
///
/// # Errors
/// None: every plan has pictures.
pub(super) fn write_frames(export: &Export) -> Result<Vec<ExportFile>, Refusal> {
    let (times, _) = times(export.plan);
    let size = (export.picture_size.0.into(), export.picture_size.1.into());
    let mut files = Vec::new();
    drawn(export, &times, &mut |colours, pixels| {
        let name = format!("{}.frames/{:04}.png", export.stem, files.len() + 1);
        files.push(ExportFile { name, bytes: view::indexed_png(size, &colours, &pixels) });
    });
    Ok(files)
}
