//! Generation of Rust code from the parameter tables in `src/endpoint/vehicle_link/params/stored`. Each file holds one group. Its
//! first line is `# group: NAME`; every other line has the columns `name, type, default, low, high, unit, text,
//! values`, separated by tabs. A type ends in `!` if the parameter is read-only. Values are `0=Off;1=On` or
//! `bits:0=First;1=Second`. `{1..8}` in a name repeats the line, and `#` in its text becomes the number.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

const COLUMNS: usize = 8;

/// Returns the Rust code of all tables in a folder, or a description of the first problem.
pub fn tables(folder: &Path) -> Result<String, String> {
    let mut code = String::new();
    for (constant, flavor) in [("PX4", "px4"), ("COPTER", "copter")] {
        let _ = writeln!(code, "/// Stored parameters of the flavor `{flavor}`.\npub const {constant}: &[Row] = &[");
        for path in files(&folder.join(flavor))? {
            let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            code.push_str(&table(&text).map_err(|error| format!("{}:{error}", path.display()))?);
        }
        code.push_str("];\n");
    }
    Ok(code)
}

fn files(folder: &Path) -> Result<Vec<std::path::PathBuf>, String> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files: Vec<_> =
        entries.flatten().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "tsv")).collect();
    files.sort();
    Ok(files)
}

fn table(text: &str) -> Result<String, String> {
    let mut lines = text.lines().enumerate();
    let group =
        lines.next().and_then(|(_, line)| line.strip_prefix("# group: ")).ok_or("1: the first line must be '# group: NAME'")?;
    let mut code = String::new();
    for (number, line) in lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')) {
        let fields: Vec<&str> = line.split('\t').collect();
        if fields.len() != COLUMNS {
            return Err(format!("{}: {} columns (allowed: {COLUMNS}, separated by tabs)", number + 1, fields.len()));
        }
        for (name, text) in repeated(fields[0], fields[6]).map_err(|error| format!("{}: {error}", number + 1))? {
            let line = row(&name, &text, group, &fields).map_err(|error| format!("{}: {error}", number + 1))?;
            code.push_str(&line);
        }
    }
    Ok(code)
}

/// Returns a name and its text, repeated for each number if the name contains a range.
fn repeated(name: &str, text: &str) -> Result<Vec<(String, String)>, String> {
    let Some((head, rest)) = name.split_once('{') else { return Ok(vec![(name.into(), text.into())]) };
    let (range, tail) = rest.split_once('}').ok_or("'{' without '}'")?;
    let (first, last) = range.split_once("..").ok_or("a range must have the form {1..8}")?;
    let number = |text: &str| text.parse::<u32>().map_err(|_| format!("'{text}' is not a whole number"));
    Ok((number(first)?..=number(last)?).map(|k| (format!("{head}{k}{tail}"), text.replace('#', &k.to_string()))).collect())
}

fn row(name: &str, text: &str, group: &str, fields: &[&str]) -> Result<String, String> {
    let (kind, read_only) = fields[1].strip_suffix('!').map_or((fields[1], ""), |kind| (kind, ".read_only()"));
    let wire = match kind {
        "int8" => "INT8",
        "int16" => "INT16",
        "int32" => "INT32",
        "float" => "REAL32",
        _ => return Err(format!("type '{kind}' (allowed: int8, int16, int32, float)")),
    };
    let number = |k: usize| fields[k].parse::<f64>().map_err(|_| format!("'{}' is not a number", fields[k]));
    let (default, low, high) = (number(2)?, number(3)?, number(4)?);
    if !(low <= default && default <= high) {
        return Err(format!("{name}: default {default} (allowed: {low} to {high})"));
    }
    let value = if wire == "REAL32" { format!("Real({default:?})") } else { format!("Int({})", default as i64) };
    let (call, pairs) = fields[7].strip_prefix("bits:").map_or(("values", fields[7]), |pairs| ("bits", pairs));
    let mut listed = String::new();
    for pair in pairs.split(';').filter(|pair| !pair.is_empty()) {
        let (code, words) = pair.split_once('=').ok_or_else(|| format!("'{pair}' (allowed: number=words)"))?;
        let code: i32 = code.parse().map_err(|_| format!("'{code}' is not a whole number"))?;
        let _ = write!(listed, "({code}, {words:?}), ");
    }
    let listed = if listed.is_empty() { String::new() } else { format!(".{call}(&[{listed}])") };
    let unit = fields[5];
    Ok(format!(
        "    row({name:?}, {value}, ({low:?}, {high:?}), {unit:?}, {group:?}, {text:?}).wire({wire}){listed}{read_only}.token(),\n"
    ))
}
