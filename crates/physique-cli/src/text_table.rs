//! Tables of text in columns, bands of columns under a common title, no wider than a terminal.

/// Widest table, in characters.
const WIDTH: usize = 100;
/// The first column gives way to the others down to this width.
const LEAST_NAME: usize = 12;
const GAP: usize = 2;

/// A column: numbers to the right, words to the left.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    /// Title over this column and those after it with none.
    pub(crate) band: &'static str,
    /// Lines of the heading.
    pub(crate) heading: Vec<String>,
    pub(crate) left: bool,
}

impl Column {
    pub(crate) fn number(band: &'static str, heading: &[&str]) -> Self {
        Self {
            band,
            heading: heading.iter().map(|&line| line.to_owned()).collect(),
            left: false,
        }
    }

    pub(crate) fn words(heading: &[&str]) -> Self {
        Self {
            left: true,
            ..Self::number("", heading)
        }
    }
}

/// A table of these columns and rows, between rules. The first column, names, is cut at its front
/// where the table would be too wide.
pub(crate) fn render(columns: &[Column], rows: &[Vec<String>]) -> String {
    let lines = columns.iter().map(|column| column.heading.len()).max();
    let lines = lines.unwrap_or(0);
    // Headings stand on the rule: shorter ones begin lower.
    let heading = |column: &Column, line: usize| {
        let missing = lines - column.heading.len();
        let index = line.checked_sub(missing);
        index.map_or(String::new(), |index| column.heading[index].clone())
    };
    let mut widths: Vec<usize> = (0..columns.len())
        .map(|index| {
            let cells = rows.iter().map(|row| width(&row[index]));
            let headings = columns[index].heading.iter().map(|line| width(line));
            cells.chain(headings).max().unwrap_or(0)
        })
        .collect();
    widen_for_bands(columns, &mut widths);
    let whole = |widths: &[usize]| widths.iter().sum::<usize>() + GAP * (widths.len() - 1);
    if let Some(over) = whole(&widths).checked_sub(WIDTH) {
        widths[0] = widths[0]
            .saturating_sub(over)
            .max(LEAST_NAME.min(widths[0]));
    }
    let rule = "─".repeat(whole(&widths)) + "\n";
    let line = |cells: Vec<String>| {
        let cells = cells.iter().zip(columns).zip(&widths);
        let padded = cells.enumerate().map(|(index, ((cell, column), &width))| {
            let cell = if index == 0 {
                end_of(cell, width)
            } else {
                cell.clone()
            };
            match column.left || index == 0 {
                true => format!("{cell:<width$}"),
                false => format!("{cell:>width$}"),
            }
        });
        let line = padded.collect::<Vec<_>>().join(&" ".repeat(GAP));
        line.trim_end().to_owned() + "\n"
    };
    let mut table = rule.clone();
    if columns.iter().any(|column| !column.band.is_empty()) {
        table += &bands(columns, &widths);
    }
    for number in 0..lines {
        table += &line(
            columns
                .iter()
                .map(|column| heading(column, number))
                .collect(),
        );
    }
    table += &rule;
    for row in rows {
        table += &line(row.clone());
    }
    table + &rule
}

fn width(text: &str) -> usize {
    text.chars().count()
}

/// Where bands begin, and the end of each.
fn band_ranges(columns: &[Column]) -> Vec<std::ops::Range<usize>> {
    let mut ranges: Vec<std::ops::Range<usize>> = Vec::new();
    for (index, column) in columns.iter().enumerate() {
        match ranges.last_mut() {
            Some(range) if column.band == columns[range.start].band => range.end = index + 1,
            _ => ranges.push(index..index + 1),
        }
    }
    ranges
}

/// A title wider than its columns widens the last of them.
fn widen_for_bands(columns: &[Column], widths: &mut [usize]) {
    for range in band_ranges(columns) {
        let inside = widths[range.clone()].iter().sum::<usize>() + GAP * (range.len() - 1);
        let title = width(columns[range.start].band);
        widths[range.end - 1] += title.saturating_sub(inside);
    }
}

/// The line of titles, each in the middle of its columns.
fn bands(columns: &[Column], widths: &[usize]) -> String {
    let titles = band_ranges(columns).into_iter().map(|range| {
        let inside = widths[range.clone()].iter().sum::<usize>() + GAP * (range.len() - 1);
        format!("{:^inside$}", columns[range.start].band)
    });
    let line = titles.collect::<Vec<_>>().join(&" ".repeat(GAP));
    line.trim_end().to_owned() + "\n"
}

/// The end of a name, which tells it from others.
fn end_of(name: &str, width: usize) -> String {
    let length = self::width(name);
    match length <= width {
        true => name.to_owned(),
        false => {
            let rest = name.chars().skip(length + 1 - width);
            std::iter::once('…').chain(rest).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_stand_over_their_columns_and_long_names_keep_their_end() {
        let columns = [
            Column::words(&["motion"]),
            Column::number("ground", &["in", "cm"]),
            Column::number("ground", &["above", "cm"]),
            Column::words(&["remark"]),
        ];
        let long = "a".repeat(120) + "_001.bvh";
        let rows = [
            vec![long, "1.0".into(), "2.0".into(), "fine".into()],
            vec!["walk".into(), "0.1".into(), "10.0".into(), String::new()],
        ];
        let table = render(&columns, &rows);
        let lines: Vec<_> = table.lines().collect();
        assert!(
            lines.iter().all(|line| line.chars().count() <= 100),
            "{table}"
        );
        assert!(lines[5].ends_with("_001.bvh  1.0    2.0  fine"), "{table}");
        let place = |line: &str, word: &str| line.split(word).next().map(|s| s.chars().count());
        let [from, to] = [place(lines[2], "in"), place(lines[3], "remark")];
        let title = place(lines[1], "ground");
        assert!(from <= title && title < to, "{table}");
    }
}
