//! Values that a structure gives a component, as a study takes them.

use std::collections::BTreeMap;

use fmi2_import::{BaseType, Causality, ModelDescription, Value as Start, Variable, suggest};
use ssp::{FlatParameter, SspError, Value};
use study::did_you_mean;

use super::wiring::named_unit;

/// What a component is told.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Values {
    /// Name of a mission that comes with the project, or path of a file.
    pub(super) mission: Option<String>,
    /// Item of its `filter`.
    pub(super) filter: Option<String>,
    /// Seed of the study.
    pub(super) seed: Option<i32>,
    /// Whether it is told the number of the run, which a study counts itself.
    pub(super) run: bool,
    /// Other parameters, as `--set` takes them; those at their start values are left out.
    pub(super) others: BTreeMap<String, String>,
}

/// Sorts the values of a component, by what a study says itself and what it sets.
///
/// # Errors
/// Binding and problem of the first value that the FMU cannot take.
pub(super) fn values(description: &ModelDescription, given: &[FlatParameter]) -> Result<Values, (String, String)> {
    let mut told = Values::default();
    // A file stands for the scenario, and a twin goes before its enumeration.
    let (mut file, mut number, mut scenario) = (None, None, None);
    let mut filters = (None, None);
    for parameter in given {
        let wrong = |problem: String| (parameter.by.clone(), problem);
        let name = parameter.name.as_str();
        let variable = description.get(name).ok_or_else(|| {
            let names = description.variables.iter().map(|v| v.name.as_str());
            let meant = suggest(name, names);
            wrong(format!(
                "there is no variable '{name}' in {}{}",
                description.model_name,
                did_you_mean(meant.as_deref())
            ))
        })?;
        if !matches!(variable.causality, Causality::Parameter | Causality::Input) {
            return Err(wrong(format!(
                "'{name}' is of causality {} and takes no value",
                variable.causality
            )));
        }
        let text = text(description, variable, parameter).map_err(wrong)?;
        let value = variable.parse_value(&text).map_err(|error| wrong(error.to_string()))?;
        let item = |variable: &str| match value {
            Start::Integer(number) if number != 0 => {
                let items = description.items(variable);
                let item = items.iter().find(|item| item.value == number);
                let item = item.ok_or_else(|| wrong(format!("'{name}' is {number}, which is no item of '{variable}'")));
                item.map(|item| Some(item.name.clone()))
            }
            _ => Ok(None),
        };
        match (name, &value) {
            ("scenario_index", _) => number = item("scenario")?,
            ("scenario", _) => scenario = item("scenario")?,
            ("filter_index", _) => filters.0 = item("filter")?,
            ("filter", _) => filters.1 = item("filter")?,
            ("mission_file", Start::String(path)) => file = (!path.is_empty()).then(|| path.clone()),
            ("study_seed", Start::Integer(seed)) => told.seed = Some(*seed),
            ("run", Start::Integer(_)) => told.run = true,
            _ if variable.start().as_ref() == Some(&value) => {}
            _ => {
                told.others.insert(name.to_owned(), text);
            }
        }
    }
    told.mission = file.or(number).or(scenario);
    told.filter = filters.0.or(filters.1);
    Ok(told)
}

/// A value as the variable's type and unit have it.
fn text(description: &ModelDescription, variable: &Variable, parameter: &FlatParameter) -> Result<String, String> {
    let fits = match &parameter.value {
        Value::Real(..) => variable.base_type() == BaseType::Real,
        Value::Integer(_) => matches!(
            variable.base_type(),
            BaseType::Real | BaseType::Integer | BaseType::Enumeration
        ),
        Value::Boolean(_) => variable.base_type() == BaseType::Boolean,
        Value::String(_) => variable.base_type() == BaseType::String,
        Value::Enumeration(_) => variable.base_type() == BaseType::Enumeration,
        Value::Other(_) => false,
    };
    if !fits {
        return Err(format!(
            "'{}' is given as {} and is {}",
            variable.name,
            parameter.value.type_name(),
            variable.base_type()
        ));
    }
    let own = named_unit(description, &variable.name);
    let value = parameter.in_unit(own.as_ref()).map_err(|error| match error {
        SspError::Units { from, to } => format!(
            "'{}' is given in '{from}' and is in '{to}'; give it in that unit, or declare both units",
            variable.name
        ),
        other => other.to_string(),
    })?;
    Ok(value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ssp::{BaseUnit, Way};

    const MODEL: &str = r#"<fmiModelDescription fmiVersion="2.0" modelName="m" guid="{g}">
      <CoSimulation modelIdentifier="m"/>
      <UnitDefinitions>
        <Unit name="m"><BaseUnit m="1"/></Unit>
        <Unit name="km"><BaseUnit m="1" factor="1000"/></Unit>
      </UnitDefinitions>
      <TypeDefinitions>
        <SimpleType name="S"><Enumeration><Item name="leo_venting" value="1"/><Item name="formation" value="3"/></Enumeration></SimpleType>
        <SimpleType name="F"><Enumeration><Item name="snc" value="1"/><Item name="imm" value="2"/></Enumeration></SimpleType>
      </TypeDefinitions>
      <ModelVariables>
        <ScalarVariable name="scenario" valueReference="0" causality="parameter" variability="fixed"><Enumeration declaredType="S" start="1"/></ScalarVariable>
        <ScalarVariable name="scenario_index" valueReference="1" causality="parameter" variability="fixed"><Integer start="0"/></ScalarVariable>
        <ScalarVariable name="mission_file" valueReference="0" causality="parameter" variability="fixed"><String start=""/></ScalarVariable>
        <ScalarVariable name="filter" valueReference="2" causality="parameter" variability="fixed"><Enumeration declaredType="F" start="1"/></ScalarVariable>
        <ScalarVariable name="filter_index" valueReference="3" causality="parameter" variability="fixed"><Integer start="0"/></ScalarVariable>
        <ScalarVariable name="study_seed" valueReference="4" causality="parameter" variability="fixed"><Integer start="1"/></ScalarVariable>
        <ScalarVariable name="run" valueReference="5" causality="parameter" variability="fixed"><Integer start="0"/></ScalarVariable>
        <ScalarVariable name="reach" valueReference="0" causality="parameter" variability="fixed"><Real start="500" unit="m"/></ScalarVariable>
        <ScalarVariable name="y" valueReference="1" causality="output"><Real/></ScalarVariable>
      </ModelVariables>
      <ModelStructure/>
    </fmiModelDescription>"#;

    fn told(parameters: &[(&str, Value)]) -> Result<Values, (String, String)> {
        let description = ModelDescription::parse(MODEL.as_bytes(), "m.xml".as_ref()).unwrap();
        let km = BaseUnit {
            exponents: [0, 1, 0, 0, 0, 0, 0, 0],
            factor: 1000.0,
            offset: 0.0,
        };
        let parameters: Vec<FlatParameter> = parameters
            .iter()
            .map(|(name, value)| FlatParameter {
                name: (*name).to_owned(),
                value: value.clone(),
                base: matches!(value, Value::Real(_, Some(unit)) if unit == "km").then_some(km),
                way: Way::default(),
                by: "binding 'b'".to_owned(),
            })
            .collect();
        values(&description, &parameters)
    }

    #[test]
    fn what_a_study_says_itself_is_kept_apart() {
        let given = [
            ("scenario_index", Value::Integer(3)),
            ("filter_index", Value::Integer(2)),
            ("study_seed", Value::Integer(7)),
            ("run", Value::Integer(4)),
            ("reach", Value::Real(0.25, Some("km".to_owned()))),
        ];
        let told = told(&given).unwrap();
        assert_eq!(told.mission.as_deref(), Some("formation"));
        assert_eq!(told.filter.as_deref(), Some("imm"));
        assert_eq!((told.seed, told.run), (Some(7), true));
        assert_eq!(told.others, BTreeMap::from([("reach".to_owned(), "250.0".to_owned())]));
    }

    #[test]
    fn a_number_of_nought_leaves_the_enumeration_and_a_start_value_is_no_setting() {
        let given = [
            ("filter_index", Value::Integer(0)),
            ("filter", Value::Enumeration("imm".to_owned())),
            ("mission_file", Value::String("fast_approach".to_owned())),
            ("reach", Value::Integer(500)),
        ];
        let told = told(&given).unwrap();
        assert_eq!(told.filter.as_deref(), Some("imm"));
        assert_eq!(told.mission.as_deref(), Some("fast_approach"));
        assert!(told.others.is_empty(), "{told:?}");
    }

    #[test]
    fn what_an_fmu_cannot_take_is_told_with_its_binding() {
        for (name, value, says) in [
            ("reech", Value::Real(1.0, None), "did you mean 'reach'"),
            ("y", Value::Real(1.0, None), "causality output"),
            ("reach", Value::Boolean(true), "given as Boolean and is Real"),
            (
                "reach",
                Value::Real(1.0, Some("mi".to_owned())),
                "given in 'mi' and is in 'm'",
            ),
            ("run", Value::Real(1.0, None), "given as Real and is Integer"),
            ("filter_index", Value::Integer(9), "no item of 'filter'"),
            ("filter", Value::Enumeration("kalman".to_owned()), "snc (1)"),
        ] {
            let (by, problem) = told(&[(name, value)]).unwrap_err();
            assert_eq!(by, "binding 'b'");
            assert!(problem.contains(says), "{problem}");
        }
    }
}
