//! Figure 4 of the paper: contact areas on the 32 x 32 grid, as a PNG of three panels.

use std::path::Path;

/// Pixels along the side of an element.
const ELEMENT: usize = 10;
/// Pixels around each panel.
const MARGIN: usize = 24;
// As in the paper, contact is blue and the exterior yellow. Lines between elements are white.
const CONTACT: [u8; 3] = [38, 64, 171];
const EXTERIOR: [u8; 3] = [250, 221, 90];
const LINE: [u8; 3] = [255, 255, 255];

/// Draws the panels (a), (b), (c) side by side. Element (0, 0) is at the lower left.
pub fn draw(path: &Path, m: usize, panels: &[Vec<bool>]) -> Result<(), Box<dyn std::error::Error>> {
    let side = m * ELEMENT;
    let (width, height) = (panels.len() * (side + MARGIN) + MARGIN, side + 2 * MARGIN);
    let mut pixels = vec![255u8; 3 * width * height];
    for (k, contact) in panels.iter().enumerate() {
        for y in 0..side {
            for x in 0..side {
                let colour = match contact[(m - 1 - y / ELEMENT) * m + x / ELEMENT] {
                    _ if x % ELEMENT == 0 || y % ELEMENT == 0 => LINE,
                    true => CONTACT,
                    false => EXTERIOR,
                };
                let at = 3 * ((y + MARGIN) * width + MARGIN + k * (side + MARGIN) + x);
                pixels[at..at + 3].copy_from_slice(&colour);
            }
        }
    }
    let file = std::io::BufWriter::new(std::fs::File::create(path)?);
    let mut encoder = png::Encoder::new(file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.write_header()?.write_image_data(&pixels)?;
    Ok(())
}
