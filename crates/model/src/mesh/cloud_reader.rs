//! Reads point clouds: LAS and LAZ files, and text with a point in each line. PLY files without faces come from the PLY reader.

use super::mesh_file::{MeshFile, check_file_size};
use super::point_cloud::{MAX_POINTS, PointCloud};
use super::vertex_colors::{Color, of_srgb};
use las::{PointData, PointDataBuilder, Reader};
use std::io::Cursor;
use std::ops::Range;
use std::panic::catch_unwind;

/// Number of points that are decoded together.
const CHUNK: u64 = 65_536;
/// Classes of points that are no part of a bridge (ASPRS LAS 1.4): ground, low noise, water, high noise.
const OTHER_CLASSES: [u8; 4] = [2, 7, 9, 18];
/// Offset of the minor version in the header, the first version with extended records, and the bytes of their place and number (LAS 1.4).
const MINOR_VERSION: usize = 25;
const EXTENDED_RECORDS_MINOR: u8 = 4;
const EXTENDED_RECORDS: Range<usize> = 235..247;
/// Offsets of the position of the points and of their format in the header, and the bit of the format that means compressed.
const POINTS_POSITION: usize = 96;
const POINT_FORMAT: usize = 104;
const COMPRESSED: u8 = 0x80;
/// Size of the smallest point, with which each chunk of compressed points begins, bytes (LAS 1.4, format 0).
const MIN_CHUNK_BYTES: usize = 20;
/// Highest value of a color of 8 bits.
const MAX_8_BIT: u16 = 255;

/// Reads a LAS or LAZ file. Points that it marks as withheld, ground, water or noise are left out. `file` is its name in messages.
///
/// # Errors
/// Returns what is wrong, with the file, the value and what is allowed.
pub(super) fn read_las(file: &str, bytes: &[u8]) -> Result<MeshFile, String> {
    check_file_size(bytes).map_err(|words| format!("{file}: {words}"))?;
    // The decoder of compressed points asserts that they are undamaged.
    catch_unwind(|| decode_las(file, bytes)).unwrap_or_else(|_| Err(format!("{file}: not a LAS or LAZ file: damaged points")))
}

fn decode_las(file: &str, bytes: &[u8]) -> Result<MeshFile, String> {
    let problem = |words: &dyn std::fmt::Display| format!("{file}: {words}");
    let invalid = |error: las::Error| problem(&format!("not a LAS or LAZ file: {error}"));
    check_chunk_count(bytes).map_err(|words| problem(&words))?;
    let mut reader = Reader::new(Cursor::new(without_extended_records(bytes))).map_err(invalid)?;
    let count = reader.header().number_of_points();
    if count > MAX_POINTS as u64 {
        return Err(problem(&format!("{count} points (allowed: at most {MAX_POINTS}; thin the cloud out)")));
    }
    let mut cloud = PointCloud::default();
    let mut chunk = PointDataBuilder::new().for_header(reader.header()).build();
    let mut colors = LasColors::default();
    let mut read = 0;
    while read < count {
        let got = reader.fill_points(CHUNK.min(count - read), &mut chunk).map_err(invalid)?;
        if got == 0 {
            return Err(problem(&format!("{read} points (allowed: {count}, as its header states)")));
        }
        read += got;
        add_chunk(&chunk, &mut cloud, &mut colors).map_err(|words| problem(&words))?;
    }
    finished(file, colors.apply(cloud))
}

/// Checks that a compressed file can contain as many chunks as its table states, because the decoder allocates memory for all of them. Anything
/// else that is wrong with the table is left to the decoder.
fn check_chunk_count(bytes: &[u8]) -> Result<(), String> {
    if bytes.get(POINT_FORMAT).is_none_or(|format| format & COMPRESSED == 0) {
        return Ok(());
    }
    let most = bytes.len() / MIN_CHUNK_BYTES;
    match stated_chunk_count(bytes) {
        Some(count) if count as usize > most => {
            Err(format!("not a LAS or LAZ file: {count} chunks (allowed: at most {most}, of the file's {} bytes)", bytes.len()))
        }
        Some(_) | None => Ok(()),
    }
}

/// Returns the number of chunks that the table of a compressed file states. The table's position comes before the points; a program that wrote
/// the file without going back has left -1 there, and the position at the end.
fn stated_chunk_count(bytes: &[u8]) -> Option<u32> {
    let four = |at: usize| bytes.get(at..)?.first_chunk().copied().map(u32::from_le_bytes);
    let eight = |at: usize| bytes.get(at..)?.first_chunk().copied().map(i64::from_le_bytes);
    let table = match eight(four(POINTS_POSITION)? as usize)? {
        -1 => eight(bytes.len().checked_sub(8)?)?,
        position => position,
    };
    // After the table's version.
    four(usize::try_from(table).ok()?.checked_add(4)?)
}

/// Returns a copy of a file whose header names no extended records: they hold no points, and a damaged one can claim any size, which the
/// decoder would allocate.
fn without_extended_records(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let has_records = bytes.get(MINOR_VERSION).is_some_and(|minor| *minor >= EXTENDED_RECORDS_MINOR);
    if let Some(records) = bytes.get_mut(EXTENDED_RECORDS).filter(|_| has_records) {
        records.fill(0);
    }
    bytes
}

/// Colors of a file, until it is known whether they have 8 or 16 bits.
#[derive(Default)]
struct LasColors {
    raw: Vec<[u16; 3]>,
}

impl LasColors {
    /// Returns the cloud with colors. Files should have 16 bits, but many have 8.
    fn apply(self, cloud: PointCloud) -> PointCloud {
        let highest = self.raw.iter().flatten().copied().max().unwrap_or(0);
        // Some programs write black for all points of a cloud without colors.
        if highest == 0 {
            return cloud;
        }
        let full = f64::from(if highest <= MAX_8_BIT { MAX_8_BIT } else { u16::MAX });
        let color = |raw: [u16; 3]| of_srgb(raw.map(|value| f64::from(value) / full));
        cloud.with_colors(self.raw.into_iter().map(color).collect())
    }
}

fn add_chunk(chunk: &PointData, cloud: &mut PointCloud, colors: &mut LasColors) -> Result<(), String> {
    // The byte with the class in the formats 0 to 5 has the flags, too; in the others, they have a byte of their own.
    let withheld = if chunk.format().is_extended { 0x04 } else { 0x80 };
    let is_withheld = chunk.raw_bytes().chunks_exact(chunk.record_len().max(1)).map(|record| record[15] & withheld != 0);
    let mut rgb = chunk.rgb();
    let places = chunk.x().zip(chunk.y()).zip(chunk.z()).map(|((x, y), z)| [x, y, z]);
    for ((p, class), is_withheld) in places.zip(chunk.classification()).zip(is_withheld) {
        let color = rgb.as_mut().and_then(Iterator::next);
        if is_withheld || OTHER_CLASSES.contains(&class) {
            cloud.left_out += 1;
            continue;
        }
        cloud.push(p, None)?;
        colors.raw.extend(color.map(|(r, g, b)| [r, g, b]));
    }
    Ok(())
}

/// Reads text: in each line x, y and z, which an intensity, a color of three values from 0 to 255, or both can follow. Blanks, commas or
/// semicolons separate the numbers. Lines that begin with # or //, and the number of points in the first line, are skipped.
///
/// # Errors
/// Returns what is wrong, with the file, the line, the value and what is allowed.
pub(super) fn read_text(file: &str, bytes: &[u8]) -> Result<MeshFile, String> {
    check_file_size(bytes).map_err(|words| format!("{file}: {words}"))?;
    let text = std::str::from_utf8(bytes).map_err(|_| format!("{file}: not a text file (allowed: UTF-8)"))?;
    let mut cloud = PointCloud::default();
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') || line.starts_with("//") {
            continue;
        }
        let is_count = cloud.is_empty() && line.parse::<u64>().is_ok();
        if !is_count {
            add_line(line, &mut cloud).map_err(|words| format!("{file}:{number}: {words}"))?;
        }
    }
    finished(file, cloud)
}

fn add_line(line: &str, cloud: &mut PointCloud) -> Result<(), String> {
    let mut values = [0.0; 7];
    let mut count = 0;
    for word in line.split([' ', '\t', ',', ';']).filter(|word| !word.is_empty()) {
        let value: f64 =
            word.parse().map_err(|_| format!("{word}: not a number (allowed: x y z, and intensity, r g b or both)"))?;
        *values.get_mut(count).ok_or("more than 7 numbers (allowed: 3, 4, 6 or 7)")? = value;
        count += 1;
    }
    let color = match count {
        3 | 4 => None,
        6 => Some([values[3], values[4], values[5]]),
        7 => Some([values[4], values[5], values[6]]),
        _ => return Err(format!("{count} numbers (allowed: 3, 4, 6 or 7)")),
    };
    let color = color.map(color_of).transpose()?;
    if !cloud.is_empty() && color.is_some() != cloud.is_colored() {
        return Err(format!("{count} numbers (allowed: a color in each line, or in none)"));
    }
    cloud.push([values[0], values[1], values[2]], color)
}

fn color_of(values: [f64; 3]) -> Result<Color, String> {
    let full = f64::from(MAX_8_BIT);
    if values.iter().all(|value| (0.0..=full).contains(value)) {
        Ok(of_srgb(values.map(|value| value / full)))
    } else {
        Err(format!("color {values:?} (allowed: 0 to 255)"))
    }
}

fn finished(file: &str, cloud: PointCloud) -> Result<MeshFile, String> {
    if cloud.is_empty() {
        return Err(format!("{file}: no points (allowed: at least one; {} were left out by their class)", cloud.left_out));
    }
    Ok(MeshFile { cloud: Some(cloud), ..MeshFile::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud(text: &str) -> PointCloud {
        read_text("scan.xyz", text.as_bytes()).unwrap().cloud.unwrap()
    }

    #[test]
    fn exact_lines_have_places_and_colors() {
        let plain: Vec<_> = cloud("# x y z\n3\n1 2 3\n4,5,6\n7;8;9;100\n").points().collect();
        assert_eq!(plain.iter().map(|point| point.0).collect::<Vec<_>>(), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
        assert!(!cloud("1 2 3\n").is_colored());
        let colored = cloud("1 2 3 255 188 0\n1 2 4 77 0 0 255\n");
        assert!(colored.is_colored());
        assert_eq!(colored.points().map(|point| point.1).collect::<Vec<_>>(), [[255, 128, 0], [0, 0, 255]]);
    }

    #[test]
    fn exact_points_far_from_the_origin_keep_their_places_to_a_millimeter() {
        let far = cloud("432100.125 5812345.625 12.5\n432160.126 5812345.001 12.753\n");
        let [_, (p, _)] = far.points().collect::<Vec<_>>()[..] else { panic!("not two points") };
        assert!(p.iter().zip([432_160.126, 5_812_345.001, 12.753]).all(|(a, b)| (a - b).abs() < 1e-3), "{p:?}");
    }

    #[test]
    fn exact_extended_records_are_ignored_from_version_1_4_on() {
        let header = |minor: u8| {
            let mut bytes = vec![0xff; 375];
            bytes[MINOR_VERSION] = minor;
            without_extended_records(&bytes)
        };
        assert!(header(4)[EXTENDED_RECORDS].iter().all(|byte| *byte == 0));
        assert_eq!(header(4).iter().filter(|byte| **byte == 0xff).count(), 375 - 1 - EXTENDED_RECORDS.len());
        assert!(header(2)[EXTENDED_RECORDS].iter().all(|byte| *byte == 0xff), "points may be there");
        assert_eq!(without_extended_records(&[1, 2]), [1, 2]);
    }

    #[test]
    fn regress_bad_lines_name_file_line_value_and_allowed() {
        let error = |text: &str| read_text("scan.xyz", text.as_bytes()).unwrap_err();
        assert_eq!(error("1 2 3\n1 2\n"), "scan.xyz:2: 2 numbers (allowed: 3, 4, 6 or 7)");
        assert_eq!(error("1 2 x\n"), "scan.xyz:1: x: not a number (allowed: x y z, and intensity, r g b or both)");
        assert_eq!(error("1 2 3 4 5 6 7 8\n"), "scan.xyz:1: more than 7 numbers (allowed: 3, 4, 6 or 7)");
        assert_eq!(error("1 2 3 0 0 256\n"), "scan.xyz:1: color [0.0, 0.0, 256.0] (allowed: 0 to 255)");
        assert_eq!(error("1 2 3 0 0 0\n1 2 3\n"), "scan.xyz:2: 3 numbers (allowed: a color in each line, or in none)");
        assert!(error("1 2 1e30\n").starts_with("scan.xyz:1: position 0 = [") && error("nan 0 0\n").starts_with("scan.xyz:1: "));
        assert!(error("# nothing\n").starts_with("scan.xyz: no points"));
        let binary = read_text("scan.xyz", &[0xff, 0xfe, 0x00]).unwrap_err();
        assert_eq!(binary, "scan.xyz: not a text file (allowed: UTF-8)");
        assert!(read_las("scan.las", b"1 2 3\n").unwrap_err().starts_with("scan.las: not a LAS or LAZ file: "));
    }
}
