//! Parameter files in QGroundControl's tab-separated text format (`.params`).

use super::{ParamRefusal, ParamValue, Params};

/// Type codes of MAV_PARAM_TYPE_INT32 and MAV_PARAM_TYPE_REAL32.
const INT32: &str = "6";
const REAL32: &str = "9";
/// Type codes of MAV_PARAM_TYPE_INT8 and MAV_PARAM_TYPE_INT16, which ArduPilot also uses.
const NARROW_TYPES: [&str; 2] = ["2", "4"];

/// An error in a line of a parameter file.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct ParamFileProblem {
    /// Line number, from 1.
    pub line: usize,
    /// What is wrong, including the allowed range.
    pub what: String,
}

/// Returns all parameters, one per line: system, component, name, value, type.
#[must_use]
pub fn write(params: &Params, system_id: u8) -> String {
    let mut out = String::from("# Parameters of a Spandrel vehicle\n# Vehicle-Id Component-Id Name Value Type\n");
    for index in 0..params.count() {
        let Some(((name, value), sent)) = params.at(index).zip(params.outgoing(index)) else { continue };
        let value = match value {
            ParamValue::Int(whole) => whole.to_string(),
            ParamValue::Real(real) => real.to_string(),
        };
        out.push_str(&format!("{system_id}\t1\t{name}\t{value}\t{}\n", sent.kind as u8));
    }
    out
}

/// Applies a parameter file. Skips read-only parameters and names that this vehicle does not have, because the file may
/// come from another vehicle.
///
/// # Errors
/// Returns all invalid lines. No parameter is set in that case.
pub fn read(params: &mut Params, text: &str) -> Result<(), Vec<ParamFileProblem>> {
    let mut fresh = params.clone();
    let mut problems = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#')) {
        if let Err(what) = read_line(&mut fresh, line) {
            problems.push(ParamFileProblem { line: index + 1, what });
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    *params = fresh;
    Ok(())
}

fn read_line(params: &mut Params, line: &str) -> Result<(), String> {
    let fields: Vec<&str> = line.split('\t').map(str::trim).collect();
    let [_, _, name, value, kind] = fields[..] else {
        return Err(format!("{} tab-separated fields, but 5 are required: vehicle, component, name, value, type", fields.len()));
    };
    // A parameter of another vehicle is skipped, regardless of its type.
    if params.range(name).is_none() {
        return Ok(());
    }
    let no_number = |allowed| format!("{name} = '{value}' is not a number (allowed: {allowed})");
    let narrow = params.param_view().cast && NARROW_TYPES.contains(&kind);
    let value_read = match kind {
        REAL32 => ParamValue::Real(value.parse().map_err(|_| no_number("a real number"))?),
        _ if kind == INT32 || narrow => ParamValue::Int(value.parse().map_err(|_| no_number("a whole number"))?),
        _ => {
            return Err(format!(
                "{name}: type '{kind}' is not supported (allowed: {INT32} for whole numbers, {REAL32} for real numbers)"
            ));
        }
    };
    match params.set_value(name, value_read) {
        Ok(()) | Err(ParamRefusal::Unknown | ParamRefusal::ReadOnly) => Ok(()),
        Err(ParamRefusal::Type) => Err(format!("{name} has the wrong type")),
        Err(ParamRefusal::OutOfRange) => {
            let (low, high) = params.range(name).unwrap_or_default();
            Err(format!("{name} = {value} is out of range (allowed: {low} to {high})"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::param_view;
    use super::super::tests::of;
    use super::*;

    fn params() -> Params {
        of(&param_view::PX4)
    }

    #[test]
    fn exact_written_parameters_read_back_identically() {
        let mut changed = params();
        changed.set_value("MIS_TAKEOFF_ALT", ParamValue::Real(7.3)).unwrap();
        changed.set_value("GF_ACTION", ParamValue::Int(3)).unwrap();
        let mut read_back = params();
        read(&mut read_back, &write(&changed, 3)).unwrap();
        assert_eq!(read_back, changed);
        let mut copter = of(&param_view::COPTER);
        copter.set_value("FENCE_ACTION", ParamValue::Int(2)).unwrap();
        copter.set_value("RTL_ALT", ParamValue::Int(2_500)).unwrap();
        let text = write(&copter, 3);
        assert!(text.contains("3\t1\tFENCE_ACTION\t2\t2\n"), "the type must be as narrow as ArduPilot's");
        let mut read_back = of(&param_view::COPTER);
        read(&mut read_back, &text).unwrap();
        assert_eq!(write(&read_back, 3), text);
    }

    #[test]
    fn exact_every_invalid_line_is_reported_and_nothing_is_set() {
        let mut before = params();
        let text = "# a comment\n1\t1\tMIS_TAKEOFF_ALT\t900\t9\n1\t1\tGF_ACTION\tmuch\t6\n1\t1\tOTHER_VEHICLE\t1\t2\n1\t1\n1\t1\tGF_ACTION\t1\t2\n1\t1\tNAV_ACC_RAD\t3\t9\n";
        let problems = read(&mut before, text).unwrap_err();
        let told: Vec<String> = problems.iter().map(ToString::to_string).collect();
        assert_eq!(told.len(), 4, "{told:?}");
        for (line, what) in told.iter().zip([
            "line 2: MIS_TAKEOFF_ALT = 900 is out of range (allowed: 0.5 to 500)",
            "line 3: GF_ACTION = 'much'",
            "line 5: 2 tab-separated fields",
            "line 6: GF_ACTION: type '2'",
        ]) {
            assert!(line.starts_with(what), "{line}");
        }
        assert_eq!(before, params());
    }
}
