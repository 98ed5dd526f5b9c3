//! Colour quantisation by median cut (Heckbert 1982), in integers.

/// The greatest number of colours of a picture with a palette: few enough that a page with it stays small.
pub(super) const COLOURS_MAX: usize = 48;

/// The bits of red, green and blue that are distinguished.
const BITS: u32 = 5;

/// A quantised colour with its statistics in the picture.
#[derive(Clone, Copy)]
struct Tone {
    /// Red, green and blue in [`BITS`] bits each.
    parts: [u8; 3],
    /// The number of pixels of this colour.
    count: u64,
    /// The sums of their red, green and blue.
    sums: [u64; 3],
}

/// Returns the palette of a picture as (red, green, blue), and the palette index of each pixel, from 0, row by row.
/// `pixels` holds red, green and blue of each pixel, one after the other.
pub(super) fn reduced(pixels: &[u8]) -> (Vec<[u8; 3]>, Vec<u8>) {
    let mut tones: Vec<Option<Tone>> = vec![None; 1 << (3 * BITS)];
    for pixel in pixels.chunks_exact(3) {
        let parts = [0, 1, 2].map(|k| pixel[k] >> (8 - BITS));
        let tone = tones[place(parts)].get_or_insert(Tone { parts, count: 0, sums: [0; 3] });
        tone.count += 1;
        (0..3).for_each(|k| tone.sums[k] += u64::from(pixel[k]));
    }
    let boxes = boxes(tones.into_iter().flatten().collect());
    let mut index = vec![0_u8; 1 << (3 * BITS)];
    for (number, tones) in boxes.iter().enumerate() {
        tones.iter().for_each(|tone| index[place(tone.parts)] = number as u8);
    }
    let of = |pixel: &[u8]| index[place([0, 1, 2].map(|k| pixel[k] >> (8 - BITS)))];
    (boxes.iter().map(|tones| mean(tones)).collect(), pixels.chunks_exact(3).map(of).collect())
}

/// Returns the index of a quantised colour in the table of all.
fn place(parts: [u8; 3]) -> usize {
    parts.iter().fold(0, |place, part| place << BITS | usize::from(*part))
}

/// Returns the mean colour of tones, rounded.
fn mean(tones: &[Tone]) -> [u8; 3] {
    let count = tones.iter().map(|tone| tone.count).sum::<u64>().max(1);
    [0, 1, 2].map(|k| ((tones.iter().map(|tone| tone.sums[k]).sum::<u64>() + count / 2) / count) as u8)
}

/// Partitions the tones into at most [`COLOURS_MAX`] boxes, the widest box cut at its median first.
fn boxes(all: Vec<Tone>) -> Vec<Vec<Tone>> {
    let mut boxes = vec![all];
    while boxes.len() < COLOURS_MAX {
        let widest = (0..boxes.len()).max_by_key(|i| (width(&boxes[*i]).0, std::cmp::Reverse(*i)));
        let Some(widest) = widest.filter(|i| width(&boxes[*i]).0 > 0) else { break };
        let (_, part) = width(&boxes[widest]);
        let mut tones = boxes.swap_remove(widest);
        tones.sort_by_key(|tone| (tone.parts[part], tone.parts));
        let half = tones.iter().map(|tone| tone.count).sum::<u64>() / 2;
        let mut before = 0;
        let median = tones.iter().position(|tone| {
            before += tone.count;
            before > half
        });
        let rest = tones.split_off(median.unwrap_or(0).clamp(1, tones.len() - 1));
        boxes.extend([tones, rest]);
    }
    boxes
}

/// Returns the extent of a box along its longest channel, and that channel.
fn width(tones: &[Tone]) -> (u8, usize) {
    let spread = |part: usize| {
        let values = || tones.iter().map(|tone| tone.parts[part]);
        values().max().unwrap_or(0) - values().min().unwrap_or(0)
    };
    [0, 1, 2].map(|part| (spread(part), part)).into_iter().max().expect("there are three")
}
