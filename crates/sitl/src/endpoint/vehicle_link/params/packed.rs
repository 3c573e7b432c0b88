//! ArduPilot's packed parameter file, `@PARAM/param.pck` over MAVLink FTP. The header consists of three 16-bit numbers:
//! the format, the number of parameters in the file, and the total number. For each parameter, the file then contains
//! the type and flags, the lengths, the part of the name that differs from the previous one, the value and, if
//! requested and different, the default.

use super::row::Row;
use super::{ParamValue, Params};
use spandrel_mavlink::dialect::MavParamType;

/// Path of the file.
const PATH: &str = "@PARAM/param.pck";
const WITHOUT_DEFAULTS: u16 = 0x671b;
const WITH_DEFAULTS: u16 = 0x671c;
/// Flag: a default follows the value.
const HAS_DEFAULT: u8 = 0x10;
/// Maximum length of the name prefix shared with the previous parameter.
const MAX_COMMON_PREFIX: usize = 15;

/// The requested part of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct ParamSelection {
    first: usize,
    count: usize,
    defaults: bool,
}

/// Returns the file if the path matches. Options after a question mark are `start`, `count` and `withdefaults`.
#[must_use]
pub fn file(path: &[u8], params: &Params, defaults: &Params) -> Option<Vec<u8>> {
    let end = path.iter().position(|byte| *byte == 0).unwrap_or(path.len());
    let text = std::str::from_utf8(&path[..end]).ok()?;
    let options = text.strip_prefix('/').unwrap_or(text).strip_prefix(PATH)?;
    Some(pack(parse_selection(options)?, params, defaults))
}

fn parse_selection(options: &str) -> Option<ParamSelection> {
    let mut selection = ParamSelection { first: 0, count: usize::MAX, defaults: false };
    if options.is_empty() {
        return Some(selection);
    }
    for option in options.strip_prefix('?')?.split('&') {
        let (name, value) = option.split_once('=')?;
        let number: usize = value.parse().ok()?;
        match name {
            "start" => selection.first = number,
            "count" => selection.count = number,
            "withdefaults" => selection.defaults = number != 0,
            _ => return None,
        }
    }
    Some(selection)
}

fn pack(selection: ParamSelection, params: &Params, defaults: &Params) -> Vec<u8> {
    let rows: Vec<&Row> = params.view.rows().iter().skip(selection.first).take(selection.count).collect();
    let mut out = Vec::new();
    for number in [if selection.defaults { WITH_DEFAULTS } else { WITHOUT_DEFAULTS }, rows.len() as u16, params.count() as u16] {
        out.extend(number.to_le_bytes());
    }
    let mut last = "";
    for row in rows {
        let (value, default) = (params.shown(row), defaults.shown(row));
        let differs = selection.defaults && value != default;
        let common = last.bytes().zip(row.name.bytes()).take_while(|(a, b)| a == b).count().min(MAX_COMMON_PREFIX);
        let rest = &row.name.as_bytes()[common..];
        out.push(kind(row.wire) | if differs { HAS_DEFAULT } else { 0 });
        out.push(((rest.len() - 1) as u8) << 4 | common as u8);
        out.extend(rest);
        put(&mut out, row.wire, value);
        if differs {
            put(&mut out, row.wire, default);
        }
        last = row.name;
    }
    out
}

/// Returns ArduPilot's number for a type.
fn kind(wire: MavParamType) -> u8 {
    match wire {
        MavParamType::MAV_PARAM_TYPE_INT8 => 1,
        MavParamType::MAV_PARAM_TYPE_INT16 => 2,
        MavParamType::MAV_PARAM_TYPE_INT32 => 3,
        _ => 4,
    }
}

fn put(out: &mut Vec<u8>, wire: MavParamType, value: ParamValue) {
    match (wire, value) {
        (MavParamType::MAV_PARAM_TYPE_INT8, ParamValue::Int(whole)) => out.extend((whole as i8).to_le_bytes()),
        (MavParamType::MAV_PARAM_TYPE_INT16, ParamValue::Int(whole)) => out.extend((whole as i16).to_le_bytes()),
        (MavParamType::MAV_PARAM_TYPE_INT32, ParamValue::Int(whole)) => out.extend(whole.to_le_bytes()),
        (_, value) => out.extend(value.cast().to_le_bytes()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::param_view;
    use super::super::tests::of;
    use super::*;

    #[test]
    fn exact_first_entries_match_byte_by_byte() {
        let (params, defaults) = (of(&param_view::COPTER), of(&param_view::COPTER));
        let rows = param_view::COPTER.rows();
        let first = rows.iter().position(|row| row.name == "AUTOTUNE_AXES").unwrap();
        assert_eq!(rows[first + 1].name, "AUTO_OPTIONS");
        let path = format!("@PARAM/param.pck?start={first}&count=2\0");
        let bytes = file(path.as_bytes(), &params, &defaults).unwrap();
        let mut expected = vec![0x1b, 0x67, 2, 0];
        expected.extend((rows.len() as u16).to_le_bytes());
        // An INT8 with thirteen new characters, value 7; an INT32 that shares four characters and has eight new ones,
        // value 0.
        expected.extend([1, 12 << 4]);
        expected.extend(b"AUTOTUNE_AXES\x07");
        expected.extend([3, 7 << 4 | 4]);
        expected.extend(b"_OPTIONS\0\0\0\0");
        assert_eq!(bytes, expected);
    }

    #[test]
    fn exact_changed_values_include_their_default() {
        let (mut params, defaults) = (of(&param_view::COPTER), of(&param_view::COPTER));
        let plain = file(b"/@PARAM/param.pck?withdefaults=1", &params, &defaults).unwrap();
        assert_eq!(plain[..2], [0x1c, 0x67]);
        params.set_value("WPNAV_SPEED", ParamValue::Real(300.0)).unwrap();
        let changed = file(b"/@PARAM/param.pck?withdefaults=1", &params, &defaults).unwrap();
        assert_eq!(changed.len(), plain.len() + 4);
        let value_and_default = [300f32.to_le_bytes(), 500f32.to_le_bytes()].concat();
        assert!(changed.windows(8).any(|window| window == value_and_default));
    }

    #[test]
    fn exact_other_paths_and_options_are_rejected() {
        let params = of(&param_view::COPTER);
        for path in
            ["param.pck", "@PARAM/param.pck.bak", "@PARAM/param.pck?start", "@PARAM/param.pck?start=-1", "@PARAM/param.pck?x=1"]
        {
            assert_eq!(file(path.as_bytes(), &params, &params), None, "{path}");
        }
        assert_eq!(file(b"@PARAM/param.pck?start=60000&count=9", &params, &params).unwrap().len(), 6);
        assert_eq!(file(&[0xff, 0xfe], &params, &params), None);
    }
}
