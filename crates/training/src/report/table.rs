//! Data tables for figures: rounded for display, full precision for download.

use super::formatting;
use maud::{Markup, html};
use spandrel_text::{Language, text};

/// A cell of a data table.
#[derive(Debug, Clone, PartialEq)]
pub enum TableCell {
    /// Text, escaped in HTML and CSV.
    Text(String),
    /// A number and the number of decimal places to display.
    Number(f64, usize),
    /// Flight duration, s.
    Clock(f64),
    /// No value.
    Empty,
}

impl From<&str> for TableCell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for TableCell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<usize> for TableCell {
    fn from(count: usize) -> Self {
        Self::Number(count as f64, 0)
    }
}

impl From<u32> for TableCell {
    fn from(count: u32) -> Self {
        Self::Number(f64::from(count), 0)
    }
}

impl TableCell {
    fn shown(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(value, digits) => formatting::number(*value, *digits),
            Self::Clock(t_s) => formatting::clock(*t_s),
            Self::Empty => String::new(),
        }
    }

    fn is_number(&self) -> bool {
        matches!(self, Self::Number(..) | Self::Clock(_))
    }

    /// Returns the cell as a CSV field. Text that a spreadsheet would treat as a formula gets a leading apostrophe.
    fn field(&self) -> String {
        match self {
            Self::Number(value, _) | Self::Clock(value) if value.is_finite() => value.to_string(),
            Self::Number(..) | Self::Clock(_) | Self::Empty => String::new(),
            Self::Text(text) => {
                let formula = text.starts_with(['=', '+', '-', '@', '\t', '\r']);
                let text = if formula { format!("'{text}") } else { text.clone() };
                if text.contains(['"', ',', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text }
            }
        }
    }
}

/// A table that can be shown and downloaded as CSV. The page shows it in the reader's language; the download is in English, so
/// that programs can read it.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// CSV file name without extension.
    pub name: &'static str,
    /// Caption shown above the table.
    pub caption: String,
    /// Column headings, as displayed.
    pub columns: Vec<String>,
    /// Rows; each has one cell per column.
    pub rows: Vec<Vec<TableCell>>,
}

/// Renders a table collapsed, below its figure. `table` returns it in a language.
#[must_use]
pub fn folded(language: Language, table: impl Fn(Language) -> Table) -> Markup {
    let shown_table = table(language);
    html! {
        details.numbers {
            summary { (text!(language, "report-table", caption = shown_table.caption.as_str())) }
            (shown_table.with_download(language, &table(Language::English)))
        }
    }
}

/// Renders a table with its download link. `table` returns it in a language.
#[must_use]
pub fn shown(language: Language, table: impl Fn(Language) -> Table) -> Markup {
    table(language).with_download(language, &table(Language::English))
}

impl Table {
    fn with_download(&self, language: Language, english: &Self) -> Markup {
        html! {
            div.scroll tabindex="0" role="region" aria-label=(text!(language, "report-table", caption = self.caption.as_str())) {
                table {
                    caption { (self.caption) }
                    thead { tr { @for column in &self.columns { th scope="col" { (column) } } } }
                    tbody {
                        @for row in &self.rows {
                            tr {
                                @for (k, cell) in row.iter().enumerate() {
                                    @if k == 0 { th scope="row" .number[cell.is_number()] { (cell.shown()) } }
                                    @else { td .number[cell.is_number()] { (cell.shown()) } }
                                }
                            }
                        }
                    }
                }
            }
            p.download { (download(&format!("{}.csv", self.name), &english.csv(), &text!(language, "report-table-download"))) }
        }
    }

    /// Returns the table as CSV with a header line and full-precision numbers.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = self.columns.iter().map(|column| TableCell::from(column.as_str()).field()).collect::<Vec<_>>().join(",");
        csv.push('\n');
        for row in &self.rows {
            csv.push_str(&row.iter().map(TableCell::field).collect::<Vec<_>>().join(","));
            csv.push('\n');
        }
        csv
    }
}

/// Renders a download link with the file as a data URL.
#[must_use]
pub fn download(name: &str, csv: &str, label: &str) -> Markup {
    let mut link = String::from("data:text/csv;charset=utf-8,");
    for byte in csv.bytes() {
        // Unreserved characters (RFC 3986).
        if byte.is_ascii_alphanumeric() || b"-._~".contains(&byte) {
            link.push(char::from(byte));
        } else {
            link.push_str(&format!("%{byte:02X}"));
        }
    }
    html! { a download=(name) href=(link) { (label) } }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Table {
        let rows = vec![vec![text.into(), TableCell::Number(1.0 / 3.0, 2), TableCell::Clock(61.5)]];
        Table { name: "t", caption: "a table".into(), columns: ["words", "x, m", "time"].map(str::to_owned).to_vec(), rows }
    }

    fn page(text: &str) -> String {
        shown(Language::English, |_| table(text)).into_string()
    }

    #[test]
    fn exact_table_is_rounded_on_page_and_exact_in_csv() {
        let page = page("a");
        assert!(page.contains("0.33") && page.contains("1:02"), "{page}");
        assert_eq!(table("a").csv(), "words,\"x, m\",time\na,0.3333333333333333,61.5\n");
        assert!(page.contains("data:text/csv;charset=utf-8,words%2C%22x%2C%20m%22"), "{page}");
    }

    #[test]
    fn exact_text_is_escaped_in_html_and_csv() {
        let evil = "=1+\"<script>alert(1)</script>\"";
        let page = page(evil);
        assert!(!page.contains("<script"), "{page}");
        assert!(table(evil).csv().contains("\"'=1+\"\"<script>"), "{}", table(evil).csv());
    }

    #[test]
    fn exact_page_is_translated_and_download_is_in_english() {
        let in_language = |language| Table { caption: text!(language, "report-column-score"), ..table("a") };
        let page = folded(Language::German, in_language).into_string();
        assert!(page.contains("<summary>Tabelle: Wertung</summary>") && page.contains("Als CSV herunterladen"), "{page}");
        let words = |language| Table { columns: vec![text!(language, "report-column-score")], rows: Vec::new(), ..table("a") };
        let page = shown(Language::German, words).into_string();
        assert!(page.contains("charset=utf-8,score%0A") && page.contains(">Wertung</th>"), "{page}");
    }
}
