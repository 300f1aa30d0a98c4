//! Values that are a plain number or a table: one visitor for both forms, so that messages name what is allowed.

use std::fmt;
use std::marker::PhantomData;

use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};

/// Reads a number with `fixed`, or a table as `T` with `table`.
pub(super) fn number_or<'de, D, T, V>(
    deserializer: D,
    expected: &'static str,
    fixed: fn(f64) -> V,
    table: fn(T) -> V,
) -> Result<V, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    struct Either<T, V> {
        expected: &'static str,
        fixed: fn(f64) -> V,
        table: fn(T) -> V,
        of: PhantomData<T>,
    }
    impl<'de, T: Deserialize<'de>, V> Visitor<'de> for Either<T, V> {
        type Value = V;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str(self.expected)
        }

        fn visit_f64<E>(self, value: f64) -> Result<V, E> {
            Ok((self.fixed)(value))
        }

        fn visit_i64<E>(self, value: i64) -> Result<V, E> {
            Ok((self.fixed)(value as f64))
        }

        fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<V, A::Error> {
            T::deserialize(MapAccessDeserializer::new(map)).map(self.table)
        }
    }
    deserializer.deserialize_any(Either {
        expected,
        fixed,
        table,
        of: PhantomData,
    })
}
