//! Variables in messages: FMI 2.0 lets an FMU name one by type and value reference, `#r123#`, and writes a number sign as `##`.

use crate::description::ModelDescription;
use crate::value::BaseType;

/// A message with its variables by name. What is no reference, or one to no variable, stays as it is.
pub(super) fn resolved(message: &str, description: &ModelDescription) -> String {
    let mut text = String::with_capacity(message.len());
    let mut rest = message;
    while let Some(at) = rest.find('#') {
        text.push_str(&rest[..at]);
        let after = &rest[at + 1..];
        if let Some(after) = after.strip_prefix('#') {
            text.push('#');
            rest = after;
        } else if let Some((name, after)) = reference(after, description) {
            text.push_str(name);
            rest = after;
        } else {
            text.push('#');
            rest = after;
        }
    }
    text + rest
}

/// The variable that `text`, which follows a number sign, begins by naming, and what comes after it.
fn reference<'d, 't>(text: &'t str, description: &'d ModelDescription) -> Option<(&'d str, &'t str)> {
    let (inside, after) = text.split_once('#')?;
    let mut letters = inside.chars();
    let fits: fn(BaseType) -> bool = match letters.next()? {
        'r' => |kind| kind == BaseType::Real,
        'i' => |kind| matches!(kind, BaseType::Integer | BaseType::Enumeration),
        'b' => |kind| kind == BaseType::Boolean,
        's' => |kind| kind == BaseType::String,
        _ => return None,
    };
    let number: u32 = letters.as_str().parse().ok()?;
    let mut variables = description.variables.iter();
    let variable = variables.find(|v| v.value_reference == number && fits(v.base_type()))?;
    Some((&variable.name, after))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn references_become_names() {
        let xml = br#"<fmiModelDescription fmiVersion="2.0" modelName="m" guid="g"><CoSimulation modelIdentifier="m"/>
            <ModelVariables>
            <ScalarVariable name="mass" valueReference="12"><Real/></ScalarVariable>
            <ScalarVariable name="count" valueReference="12"><Integer/></ScalarVariable>
            <ScalarVariable name="open" valueReference="3"><Boolean/></ScalarVariable>
            <ScalarVariable name="label" valueReference="0"><String/></ScalarVariable>
            <ScalarVariable name="weight" valueReference="12"><Real/></ScalarVariable>
            </ModelVariables></fmiModelDescription>"#;
        let description = ModelDescription::parse(xml, Path::new("m.xml")).unwrap();
        for (message, expected) in [
            (
                "#r12# must exceed #i12#, #b3# and #s0#",
                "mass must exceed count, open and label",
            ),
            ("no. ##1, not #1", "no. #1, not #1"),
            ("##r12##", "#r12#"),
            (
                "#r13# #x1# #r# #r-1# #r99999999999#",
                "#r13# #x1# #r# #r-1# #r99999999999#",
            ),
            ("#r12", "#r12"),
            ("a # b #r12#", "a # b mass"),
            ("#", "#"),
            ("\u{fc}#b3#\u{fc}", "\u{fc}open\u{fc}"),
        ] {
            assert_eq!(resolved(message, &description), expected);
        }
    }
}
