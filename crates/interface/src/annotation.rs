//! What a navigation FMU tells the harness beside its variables: presets, search ranges, where a filter has a meaning, and which
//! are bounds.
//!
//! It stands in `modelDescription.xml` as a vendor annotation for [`TOOL`], one `Filters` element. The structs here are what
//! fmu-nav writes with serde and what the harness reads with [`Filters::read`].

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Name of the tool that the annotation is for.
pub const TOOL: &str = "trade-harness";

/// The annotation.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Filters {
    /// Named parameter sets.
    #[serde(rename = "Presets", with = "preset_list", default)]
    pub presets: Vec<Preset>,
    /// Ranges that a search for the best tuning may vary.
    #[serde(rename = "Searches", with = "search_list", default)]
    pub searches: Vec<Search>,
    /// Filters that have a meaning in some scenarios only; the others have one everywhere.
    #[serde(rename = "Meaning", with = "only_list", default)]
    pub meanings: Vec<Only>,
    /// Filters that are told by the truth what no filter knows: bounds, to be fed `truth.*` and never to be ranked.
    #[serde(rename = "Bounds", with = "bound_list", default)]
    pub bounds: Vec<Bound>,
}

/// A filter that is a bound.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Bound {
    /// The filter.
    #[serde(rename = "@filter")]
    pub filter: String,
}

/// A named parameter set of one filter.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Preset {
    /// The filter it belongs to.
    #[serde(rename = "@filter")]
    pub filter: String,
    /// Name of the set.
    #[serde(rename = "@name")]
    pub name: String,
    /// What it stands for.
    #[serde(rename = "@about", default)]
    pub about: String,
    /// Whether it reads its source in another way, which is a filter of its own in a search.
    #[serde(rename = "@otherReading", default, skip_serializing_if = "std::ops::Not::not")]
    pub other_reading: bool,
    /// What it sets.
    #[serde(rename = "Set", default)]
    pub sets: Vec<Set>,
}

/// One variable of a preset.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Set {
    /// Name of the variable.
    #[serde(rename = "@variable")]
    pub variable: String,
    /// Its value, as text.
    #[serde(rename = "@value")]
    pub value: String,
}

/// A range over which a search may vary a parameter, as stated: nothing about it is checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Search {
    /// Name of the parameter.
    #[serde(rename = "@variable")]
    pub variable: String,
    /// Smallest value, in the unit of the variable.
    #[serde(rename = "@low", with = "number")]
    pub low: f64,
    /// Largest value.
    #[serde(rename = "@high", with = "number")]
    pub high: f64,
    /// What has to be set for the parameter to have an effect, as `VARIABLE=VALUE`; nothing where it always has one.
    #[serde(
        rename = "@onlyWith",
        with = "setting",
        default,
        skip_serializing_if = "Option::is_none"
    )]
    pub only_with: Option<Set>,
}

/// Where a filter has a meaning.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Only {
    /// The filter.
    #[serde(rename = "@filter")]
    pub filter: String,
    /// The scenarios in which it has one.
    #[serde(rename = "@scenarios", with = "names")]
    pub scenarios: Vec<String>,
    /// The frame of `navigation.frame` in which it has one in any mission.
    #[serde(rename = "@frame", default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<String>,
    /// Why not in the others.
    #[serde(rename = "@why", default)]
    pub why: String,
}

/// Why an annotation cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{TOOL} annotation: {reason} in {place}")]
pub struct AnnotationError {
    /// What is missing or wrong.
    pub reason: String,
    /// The tag in question.
    pub place: String,
}

impl Filters {
    /// Reads every annotation for [`TOOL`] of one FMU; what several of them say adds up, and none at all says nothing.
    ///
    /// * `annotations`: the XML inside each.
    ///
    /// # Errors
    /// The first attribute that is missing or cannot be read, with the tag it belongs to.
    pub fn read<'a>(annotations: impl IntoIterator<Item = &'a str>) -> Result<Self, AnnotationError> {
        let mut all = Self::default();
        for xml in annotations {
            let mut source = quick_xml::de::Deserializer::from_str(xml);
            let told = Self::deserialize(&mut source).map_err(|error| {
                let end = usize::try_from(source.get_ref().get_ref().buffer_position()).unwrap_or(usize::MAX);
                AnnotationError {
                    reason: error.to_string().replace("field `@", "attribute `"),
                    place: tag_before(xml, end).to_owned(),
                }
            })?;
            all.presets.extend(told.presets);
            all.searches.extend(told.searches);
            all.meanings.extend(told.meanings);
            all.bounds.extend(told.bounds);
        }
        Ok(all)
    }

    /// The presets of one filter.
    pub fn presets_of<'a>(&'a self, filter: &'a str) -> impl Iterator<Item = &'a Preset> {
        self.presets.iter().filter(move |preset| preset.filter == filter)
    }

    /// Whether a filter is a bound.
    pub fn is_bound(&self, filter: &str) -> bool {
        self.bounds.iter().any(|bound| bound.filter == filter)
    }

    /// Why a filter has no meaning in a scenario; `None` where it has one.
    ///
    /// * `frame`: the mission's `navigation.frame`.
    pub fn without_meaning(&self, filter: &str, scenario: &str, frame: &str) -> Option<&str> {
        let has_one =
            |only: &&Only| only.frame.as_deref() == Some(frame) || only.scenarios.iter().any(|name| name == scenario);
        let mut told = self.meanings.iter().filter(|only| only.filter == filter);
        told.find(|only| !has_one(only)).map(|only| only.why.as_str())
    }
}

/// The last tag of `xml` that ends at or before `end`.
fn tag_before(xml: &str, end: usize) -> &str {
    let read = xml.get(..end).unwrap_or(xml);
    let tag = read.rfind('<').and_then(|start| read.get(start..)).unwrap_or(read);
    tag.trim_end()
}

/// A list that has an element of its own around it.
macro_rules! list {
    ($module:ident of $item:ident as $tag:literal) => {
        mod $module {
            use super::*;

            #[derive(Serialize)]
            struct Given<'a> {
                #[serde(rename = $tag)]
                items: &'a [$item],
            }

            #[derive(Deserialize)]
            struct Found {
                #[serde(rename = $tag, default)]
                items: Vec<$item>,
            }

            pub(super) fn serialize<S: Serializer>(items: &[$item], to: S) -> Result<S::Ok, S::Error> {
                Given { items }.serialize(to)
            }

            pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<$item>, D::Error> {
                Found::deserialize(from).map(|found| found.items)
            }
        }
    };
}
list!(preset_list of Preset as "Preset");
list!(search_list of Search as "Search");
list!(only_list of Only as "Only");
list!(bound_list of Bound as "Bound");

/// A number in the shortest form that reads back to the same bits.
mod number {
    use super::*;

    pub(super) fn serialize<S: Serializer>(number: &f64, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(&format_args!("{number:?}"))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        let text = String::deserialize(from)?;
        let number = text.trim().parse();
        number.map_err(|_| serde::de::Error::custom(format!("{text:?} is no number")))
    }
}

/// A variable and its value, `VARIABLE=VALUE`.
mod setting {
    use super::*;

    pub(super) fn serialize<S: Serializer>(set: &Option<Set>, to: S) -> Result<S::Ok, S::Error> {
        match set {
            Some(Set { variable, value }) => to.collect_str(&format_args!("{variable}={value}")),
            None => to.serialize_none(),
        }
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Set>, D::Error> {
        let text = String::deserialize(from)?;
        let Some((variable, value)) = text.split_once('=') else {
            return Err(serde::de::Error::custom(format!("{text:?} is not VARIABLE=VALUE")));
        };
        Ok(Some(Set {
            variable: variable.trim().to_owned(),
            value: value.trim().to_owned(),
        }))
    }
}

/// Names with commas between them.
mod names {
    use super::*;

    pub(super) fn serialize<S: Serializer>(names: &[String], to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&names.join(","))
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<String>, D::Error> {
        let text = String::deserialize(from)?;
        Ok(text.split(',').map(|name| name.trim().to_owned()).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const XML: &str = r#"<Filters>
      <Presets>
        <Preset filter="milton" name="paper" about="as published"/>
        <Preset filter="milton" name="consistent" about="as derived &amp; &apos;so&apos;">
          <Set variable="milton.residuals" value="consistent"/>
          <Set variable="milton.label" value=""/>
        </Preset>
      </Presets>
      <Meaning>
        <Only filter="observer" scenarios="formation, far" why="it needs the state measured in full"/>
      </Meaning>
      <Searches>
        <Search variable="gate" low="1e-7" high=" 0.01"/>
        <Search variable="milton.r_w" low="1" high="2" onlyWith="milton.residuals=consistent"/>
      </Searches>
      <Bounds><Bound filter="oracle"/></Bounds>
      <Later thing="unknown today"/>
    </Filters>"#;

    fn read(xml: &str) -> Result<Filters, AnnotationError> {
        Filters::read([xml])
    }

    #[test]
    fn everything_is_read() {
        let filters = read(XML).unwrap();
        let set = |variable: &str, value: &str| Set {
            variable: variable.to_owned(),
            value: value.to_owned(),
        };
        let consistent = Preset {
            other_reading: false,
            filter: "milton".to_owned(),
            name: "consistent".to_owned(),
            about: "as derived & 'so'".to_owned(),
            sets: vec![set("milton.residuals", "consistent"), set("milton.label", "")],
        };
        assert_eq!(filters.presets[1], consistent);
        let names: Vec<_> = filters.presets_of("milton").map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["paper", "consistent"]);
        assert_eq!(filters.presets_of("snc").count(), 0);
        let gate = Search {
            variable: "gate".to_owned(),
            low: 1e-7,
            high: 1e-2,
            only_with: None,
        };
        let r_w = Search {
            variable: "milton.r_w".to_owned(),
            low: 1.0,
            high: 2.0,
            only_with: Some(set("milton.residuals", "consistent")),
        };
        assert_eq!(filters.searches, [gate, r_w]);
        assert_eq!(filters.meanings[0].scenarios, ["formation", "far"]);
        assert!(filters.is_bound("oracle") && !filters.is_bound("milton"));
    }

    #[test]
    fn annotations_add_up_and_none_says_nothing() {
        assert_eq!(Filters::read([]), Ok(Filters::default()));
        assert_eq!(read("<Filters/>"), Ok(Filters::default()));
        let twice = Filters::read([XML, XML]).unwrap();
        assert_eq!(
            (twice.presets.len(), twice.searches.len(), twice.meanings.len()),
            (4, 4, 2)
        );
    }

    #[test]
    fn a_filter_has_a_meaning_everywhere_unless_the_annotation_says_otherwise() {
        let filters = read(XML).unwrap();
        let why = "it needs the state measured in full";
        for (filter, scenario, expected) in [
            ("observer", "formation", None),
            ("observer", "far", None),
            ("observer", "form", Some(why)),
            ("milton", "form", None),
        ] {
            assert_eq!(
                filters.without_meaning(filter, scenario, "inertial"),
                expected,
                "{filter} in {scenario}"
            );
        }
    }

    #[test]
    fn what_is_missing_or_wrong_is_named_with_its_tag() {
        for (from, to, reason, place) in [
            (
                " value=\"\"",
                "",
                "missing attribute `value`",
                "<Set variable=\"milton.label\"/>",
            ),
            (
                "Preset filter=\"milton\" name=\"paper\"",
                "Preset name=\"paper\"",
                "missing attribute `filter`",
                "<Preset ",
            ),
            (
                "filter=\"observer\" ",
                "",
                "missing attribute `filter`",
                "<Only scenarios",
            ),
            (
                "scenarios=\"formation, far\" ",
                "",
                "missing attribute `scenarios`",
                "<Only filter",
            ),
            (
                " low=\"1e-7\"",
                "",
                "missing attribute `low`",
                "<Search variable=\"gate\"",
            ),
            (" 0.01", "much", "\"much\" is no number", "<Search variable=\"gate\""),
            (
                "residuals=consistent",
                "residuals",
                "\"milton.residuals\" is not VARIABLE=VALUE",
                "<Search variable=\"milton.r_w\"",
            ),
            (
                "Search variable=\"gate\"",
                "Search",
                "missing attribute `variable`",
                "<Search low",
            ),
        ] {
            assert!(XML.contains(from), "{from}");
            let error = read(&XML.replacen(from, to, 1)).unwrap_err();
            assert_eq!(error.reason, reason, "{error}");
            assert!(error.place.starts_with(place), "{error}");
        }
    }

    #[test]
    fn what_is_written_is_read_again() {
        let filters = read(XML).unwrap();
        let text = quick_xml::se::to_string(&filters).unwrap();
        assert!(
            text.starts_with("<Filters><Presets><Preset filter=\"milton\" name=\"paper\""),
            "{text}"
        );
        assert!(text.contains("low=\"1e-7\" high=\"0.01\"/>"), "{text}");
        assert!(
            text.contains("high=\"2.0\" onlyWith=\"milton.residuals=consistent\"/>"),
            "{text}"
        );
        assert!(text.contains("scenarios=\"formation,far\""), "{text}");
        assert_eq!(read(&text).unwrap(), filters);
    }
}
