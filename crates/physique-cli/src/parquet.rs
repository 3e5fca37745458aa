//! Parquet files: columns that pandas, Polars, DuckDB, Spark and Ray read.

use std::sync::Arc;

use anyhow::Result;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

/// A named column; values may be missing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) values: Values,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Values {
    Words(Vec<Option<String>>),
    Numbers(Vec<Option<f64>>),
}

impl Column {
    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        match &self.values {
            Values::Words(values) => values.len(),
            Values::Numbers(values) => values.len(),
        }
    }

    /// A value as text; empty where it is missing.
    pub(crate) fn text(&self, row: usize) -> String {
        match &self.values {
            Values::Words(values) => values[row].clone().unwrap_or_default(),
            Values::Numbers(values) => values[row].map_or(String::new(), |v| v.to_string()),
        }
    }

    fn schema(&self) -> Result<Arc<Type>> {
        let builder = match &self.values {
            Values::Words(_) => Type::primitive_type_builder(&self.name, Physical::BYTE_ARRAY)
                .with_logical_type(Some(LogicalType::String)),
            Values::Numbers(_) => Type::primitive_type_builder(&self.name, Physical::DOUBLE),
        };
        Ok(Arc::new(
            builder.with_repetition(Repetition::OPTIONAL).build()?,
        ))
    }
}

/// The bytes of a Parquet file of one row group, the same for the same columns. `about` goes into
/// the file's metadata.
pub(crate) fn parquet(columns: &[Column], about: &(String, String)) -> Result<Vec<u8>> {
    let fields = columns.iter().map(Column::schema).collect::<Result<_>>()?;
    let schema = Type::group_type_builder("schema")
        .with_fields(fields)
        .build()?;
    let about = KeyValue::new(about.0.clone(), about.1.clone());
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(vec![about]))
        .build();
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for column in columns {
        let Some(mut target) = group.next_column()? else {
            break;
        };
        match &column.values {
            Values::Words(values) => {
                let words = values.iter().flatten().map(|word| ByteArray::from(&**word));
                let words: Vec<_> = words.collect();
                let known = known(values);
                target
                    .typed::<ByteArrayType>()
                    .write_batch(&words, Some(&known), None)?;
            }
            Values::Numbers(values) => {
                let numbers: Vec<_> = values.iter().flatten().copied().collect();
                let known = known(values);
                target
                    .typed::<DoubleType>()
                    .write_batch(&numbers, Some(&known), None)?;
            }
        }
        target.close()?;
    }
    group.close()?;
    Ok(writer.into_inner()?)
}

/// Definition levels: 1 where there is a value.
fn known<T>(values: &[Option<T>]) -> Vec<i16> {
    values
        .iter()
        .map(|value| i16::from(value.is_some()))
        .collect()
}

#[cfg(test)]
mod tests {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::{Field, RowAccessor};

    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let columns = [
            Column {
                name: "file".into(),
                values: Values::Words(vec![Some("größe.bvh".into()), None, Some("b".into())]),
            },
            Column {
                name: "mean_cm3".into(),
                values: Values::Numbers(vec![Some(0.1), Some(f64::MAX), None]),
            },
        ];
        let bytes = parquet(&columns, &("physique".into(), "{}".into())).unwrap();
        assert_eq!(
            bytes,
            parquet(&columns, &("physique".into(), "{}".into())).unwrap()
        );
        let reader = SerializedFileReader::new(bytes::Bytes::from(bytes)).unwrap();
        let metadata = reader.metadata().file_metadata();
        assert_eq!(metadata.key_value_metadata().unwrap()[0].key, "physique");
        let rows: Vec<_> = reader
            .get_row_iter(None)
            .unwrap()
            .map(Result::unwrap)
            .collect();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[0].get_string(0).unwrap(), "größe.bvh");
        assert_eq!(rows[1].get_double(1).unwrap(), f64::MAX);
        let missing = |row: usize, column: usize| {
            let field = rows[row].get_column_iter().nth(column).unwrap().1;
            *field == Field::Null
        };
        assert!(missing(1, 0) && missing(2, 1));
    }

    #[test]
    fn a_table_may_be_empty() {
        let columns = [Column {
            name: "file".into(),
            values: Values::Words(Vec::new()),
        }];
        let bytes = parquet(&columns, &(String::new(), String::new())).unwrap();
        assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    }
}
