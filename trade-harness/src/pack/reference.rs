//! What an FMU answers, for whoever wants to know whether it does so in their tool, too: the files that the FMI cross-check rules
//! (version 4.1, 9.1.4 and appendix B) name, made by running it.

use fmi2_import::{BaseType, Causality, Experiment, Fmu, ImportError, Instance, ModelDescription, Value, Variable};
use study::TRUTH;

use super::Files;

/// Communication steps that are shown, at most: with a step of 1 s ten minutes.
const STEPS: u32 = 600;

/// Outputs of the world that are shown; the rules ask for ten at most.
const OF_TRUTH: [&str; 10] = [
    "sample_count",
    "lidar.range",
    "lidar.azimuth",
    "lidar.elevation",
    "truth.r_tc_n[1]",
    "truth.r_tc_n[2]",
    "truth.r_tc_n[3]",
    "truth.v_tc_n[1]",
    "truth.v_tc_n[2]",
    "truth.v_tc_n[3]",
];

/// Outputs of the filter that are shown.
const OF_NAV: [&str; 10] = [
    "est.time",
    "est.count",
    "est.r_tc_n[1]",
    "est.r_tc_n[2]",
    "est.r_tc_n[3]",
    "est.v_tc_n[1]",
    "est.v_tc_n[2]",
    "est.v_tc_n[3]",
    "nis",
    "status_index",
];

/// Values by time, the first column.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Table {
    names: Vec<String>,
    rows: Vec<Vec<Value>>,
}

impl Table {
    /// The columns of these names, after the time; those that there are.
    fn only(&self, wanted: impl Fn(&str) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.names.len())
            .filter(|i| *i == 0 || wanted(&self.names[*i]))
            .collect();
        Self {
            names: kept.iter().map(|i| self.names[*i].clone()).collect(),
            rows: (self.rows.iter())
                .map(|row| kept.iter().map(|i| row[*i].clone()).collect())
                .collect(),
        }
    }

    /// As CSV of the rules: names in quotes, numbers that read back to the same bits, 0 and 1 for truth values.
    ///
    /// * `whole`: elements of an array in one column of its name, a space between them, as FMPy takes arrays of FMI 3.0.
    fn csv(&self, whole: bool) -> String {
        let array = |name: &str| name.split('[').next().unwrap_or_default().to_owned();
        let column = |name: &String| if whole { array(name) } else { name.clone() };
        let columns: Vec<String> = self.names.iter().map(column).collect();
        let line = |cells: Vec<String>| {
            let mut line = String::new();
            for (i, cell) in cells.iter().enumerate() {
                match i.checked_sub(1).and_then(|before| columns.get(before)) {
                    None => {}
                    Some(before) if *before == columns[i] => line.push(' '),
                    Some(_) => line.push(','),
                }
                line.push_str(cell);
            }
            line + "\n"
        };
        let mut names: Vec<String> = columns.iter().map(|name| format!("\"{name}\"")).collect();
        names.dedup();
        let mut text = names.join(",") + "\n";
        for row in &self.rows {
            text.push_str(&line(row.iter().map(cell).collect()));
        }
        text
    }
}

fn cell(value: &Value) -> String {
    match value {
        Value::Real(x) => format!("{x:?}"),
        Value::Integer(n) => n.to_string(),
        Value::Boolean(b) => u8::from(*b).to_string(),
        Value::String(text) => text.clone(),
    }
}

/// What an FMU answered, and to what.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reference {
    name: String,
    step: f64,
    stop: f64,
    input: Option<Table>,
    result: Table,
}

impl Reference {
    /// Runs an FMU: the world alone, and then the filter, which is handed what the world's outputs were at the begin of each step.
    ///
    /// * `world`: what the world said, for the filter; set by the world's own run.
    ///
    /// # Errors
    /// What the FMU answers.
    pub(super) fn of(fmu: &Fmu, world: &mut Table) -> Result<Self, ImportError> {
        let d = fmu.description();
        let suggested = d.default_experiment;
        let step = suggested.step_size.unwrap_or(1.0);
        let steps = suggested
            .stop_time
            .map_or(STEPS, |stop| (stop / step) as u32)
            .min(STEPS);
        let (input, result) = if d.model_name == TRUTH {
            *world = run(fmu, &outputs(d, |_| true), &Table::default(), steps, step)?;
            (None, world.only(|name| OF_TRUTH.contains(&name)))
        } else {
            let is_input = |name: &str| d.get(name).is_some_and(|v| v.causality == Causality::Input);
            let input = world.only(is_input);
            let result = run(fmu, &outputs(d, |name| OF_NAV.contains(&name)), &input, steps, step)?;
            (Some(input), result)
        };
        let stop = f64::from(steps) * step;
        let name = d.model_name.clone();
        Ok(Self {
            name,
            step,
            stop,
            input,
            result,
        })
    }

    /// The files of the rules; and the same with arrays whole, as FMI 3.0 has them.
    pub(super) fn files(&self) -> [Files; 2] {
        let Self { name, step, stop, .. } = self;
        let options = format!(
            "StartTime, 0.0\nStopTime, {stop:?}\nStepSize, {step:?}\nRelTol, 1e-12\nOutputIntervalLength, {step:?}\n"
        );
        [false, true].map(|whole| {
            let mut files = Files::from([
                (format!("{name}_ref.csv"), self.result.csv(whole).into_bytes()),
                (format!("{name}_ref.opt"), options.clone().into_bytes()),
            ]);
            if let Some(input) = &self.input {
                files.insert(format!("{name}_in.csv"), input.csv(whole).into_bytes());
            }
            files
        })
    }
}

/// The outputs of these names that are numbers or truth values.
fn outputs(d: &ModelDescription, wanted: impl Fn(&str) -> bool) -> Vec<&Variable> {
    (d.variables.iter())
        .filter(|v| v.causality == Causality::Output && v.base_type() != BaseType::String && wanted(&v.name))
        .collect()
}

/// The values of some variables at the start and after each step.
///
/// * `input`: what is set at the start and before each step, row by row.
fn run(fmu: &Fmu, shown: &[&Variable], input: &Table, steps: u32, step: f64) -> Result<Table, ImportError> {
    let inputs: Vec<&Variable> = (input.names.iter().skip(1))
        .filter_map(|name| fmu.description().get(name))
        .collect();
    let hand_over = |instance: &mut Instance, row: usize| -> Result<(), ImportError> {
        let values = input.rows.get(row).into_iter().flat_map(|row| row.iter().skip(1));
        inputs
            .iter()
            .zip(values)
            .try_for_each(|(v, value)| set(instance, v, value))
    };
    let read = |instance: &mut Instance, time: f64| -> Result<Vec<Value>, ImportError> {
        let values = shown.iter().map(|v| get(instance, v));
        std::iter::once(Ok(Value::Real(time))).chain(values).collect()
    };
    let mut instance = fmu.instantiate("reference", false)?;
    instance.setup_experiment(&Experiment {
        start_time: 0.0,
        stop_time: Some(f64::from(steps) * step),
        tolerance: None,
    })?;
    instance.enter_initialization()?;
    hand_over(&mut instance, 0)?;
    instance.exit_initialization()?;
    let mut rows = vec![read(&mut instance, 0.0)?];
    for k in 0..steps {
        hand_over(&mut instance, k as usize)?;
        let _warned = instance.do_step(f64::from(k) * step, step)?;
        rows.push(read(&mut instance, f64::from(k + 1) * step)?);
    }
    let names = std::iter::once("time".to_owned()).chain(shown.iter().map(|v| v.name.clone()));
    Ok(Table {
        names: names.collect(),
        rows,
    })
}

fn get(instance: &mut Instance, variable: &Variable) -> Result<Value, ImportError> {
    let reference = [variable.value_reference];
    Ok(match variable.base_type() {
        BaseType::Real => {
            let mut value = [0.0];
            instance.get_real(&reference, &mut value)?;
            Value::Real(value[0])
        }
        BaseType::Boolean => {
            let mut value = [false];
            instance.get_boolean(&reference, &mut value)?;
            Value::Boolean(value[0])
        }
        BaseType::Integer | BaseType::Enumeration => {
            let mut value = [0];
            instance.get_integer(&reference, &mut value)?;
            Value::Integer(value[0])
        }
        BaseType::String => Value::String(instance.get_string(&reference)?.concat()),
    })
}

fn set(instance: &mut Instance, variable: &Variable, value: &Value) -> Result<(), ImportError> {
    let reference = [variable.value_reference];
    match value {
        Value::Real(x) => instance.set_real(&reference, &[*x]),
        Value::Integer(n) => instance.set_integer(&reference, &[*n]),
        Value::Boolean(b) => instance.set_boolean(&reference, &[*b]),
        Value::String(text) => instance.set_string(&reference, &[text]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_written_as_the_rules_have_it_and_arrays_whole_where_asked() {
        let table = Table {
            names: ["time", "r[1]", "r[2]", "seen", "n"].map(str::to_owned).to_vec(),
            rows: vec![vec![
                Value::Real(0.5),
                Value::Real(1e-7),
                Value::Real(-2.0),
                Value::Boolean(true),
                Value::Integer(3),
            ]],
        };
        let scalars = "\"time\",\"r[1]\",\"r[2]\",\"seen\",\"n\"\n0.5,1e-7,-2.0,1,3\n";
        assert_eq!(table.csv(false), scalars);
        assert_eq!(table.csv(true), "\"time\",\"r\",\"seen\",\"n\"\n0.5,1e-7 -2.0,1,3\n");
        assert_eq!(table.only(|name| name == "n").csv(false), "\"time\",\"n\"\n0.5,3\n");
    }
}
