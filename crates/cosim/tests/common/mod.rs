//! A slave in plain Rust that does what a test tells it and writes down every call.

#![allow(dead_code, reason = "each test file uses a part")]

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use cosim::{BaseType, Causality, Experiment, Port, Slave, SlaveError, System, Unit};

/// Calls of all slaves of a test, in their order.
pub type Journal = Arc<Mutex<Vec<String>>>;

pub fn entries(journal: &Journal) -> Vec<String> {
    std::mem::take(&mut *journal.lock().unwrap())
}

type Law = Box<dyn FnMut(&mut BTreeMap<String, f64>, f64, f64) + Send>;

/// A slave with values by name. All types are kept as numbers.
pub struct Mock {
    name: String,
    ports: Vec<Port>,
    first: BTreeMap<String, f64>,
    values: BTreeMap<String, f64>,
    texts: BTreeMap<String, String>,
    law: Law,
    /// Runs after each set: what the outputs are as a function of the inputs.
    feedthrough: Law,
    /// Entry that fails, and at which of its calls, from 1.
    fails: Option<(String, u32)>,
    journal: Journal,
}

impl Mock {
    pub fn new(name: &str, journal: &Journal) -> Self {
        Self {
            name: name.to_owned(),
            ports: Vec::new(),
            first: BTreeMap::new(),
            values: BTreeMap::new(),
            texts: BTreeMap::new(),
            law: Box::new(|_, _, _| {}),
            feedthrough: Box::new(|_, _, _| {}),
            fails: None,
            journal: Arc::clone(journal),
        }
    }

    pub fn port(mut self, name: &str, kind: BaseType, causality: Causality, start: f64) -> Self {
        self.ports
            .push(Port::new(name, self.ports.len() as u32, kind, causality));
        self.first.insert(name.to_owned(), start);
        self.values.insert(name.to_owned(), start);
        self
    }

    /// Gives the newest port a unit.
    pub fn unit(mut self, unit: &Unit) -> Self {
        let port = self.ports.pop().unwrap();
        self.ports.push(port.with_unit(Some(Arc::new(unit.clone()))));
        self
    }

    pub fn input(self, name: &str) -> Self {
        self.port(name, BaseType::Real, Causality::Input, 0.0)
    }

    pub fn output(self, name: &str, start: f64) -> Self {
        self.port(name, BaseType::Real, Causality::Output, start)
    }

    /// What a step does: values, t, h.
    pub fn step(mut self, law: impl FnMut(&mut BTreeMap<String, f64>, f64, f64) + Send + 'static) -> Self {
        self.law = Box::new(law);
        self
    }

    pub fn feedthrough(mut self, law: impl FnMut(&mut BTreeMap<String, f64>, f64, f64) + Send + 'static) -> Self {
        self.feedthrough = Box::new(law);
        self
    }

    /// Lets the `nth` call of `function` fail.
    pub fn fail(mut self, function: &str, nth: u32) -> Self {
        self.fails = Some((function.to_owned(), nth));
        self
    }

    pub fn add_to(self, system: &mut System) -> cosim::SlaveId {
        system.add(Box::new(self)).unwrap()
    }

    fn enter(&mut self, function: &str) -> Result<(), SlaveError> {
        self.journal.lock().unwrap().push(format!("{}.{function}", self.name));
        match &mut self.fails {
            Some((which, left)) if which == function => {
                *left -= 1;
                if *left == 0 {
                    self.fails = None;
                    return Err(SlaveError {
                        function: function.to_owned(),
                        status: "fmi2Error".to_owned(),
                        messages: vec!["told to fail".to_owned()],
                    });
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn get<T>(&mut self, function: &str, refs: &[u32], out: &mut [T], to: fn(f64) -> T) -> Result<(), SlaveError> {
        self.enter(function)?;
        assert_eq!(refs.len(), out.len());
        for (r, v) in refs.iter().zip(out) {
            *v = to(self.values[&self.ports[*r as usize].name]);
        }
        Ok(())
    }

    fn set(&mut self, function: &str, refs: &[u32], values: impl Iterator<Item = f64>) -> Result<(), SlaveError> {
        self.enter(function)?;
        for (r, v) in refs.iter().zip(values) {
            self.values.insert(self.ports[*r as usize].name.clone(), v);
        }
        (self.feedthrough)(&mut self.values, 0.0, 0.0);
        Ok(())
    }
}

impl Slave for Mock {
    fn name(&self) -> &str {
        &self.name
    }
    fn ports(&self) -> Vec<Port> {
        self.ports.clone()
    }
    fn setup(&mut self, experiment: &Experiment) -> Result<(), SlaveError> {
        self.enter(&format!("setup {}..{:?}", experiment.start_time, experiment.stop_time))
    }
    fn enter_initialization(&mut self) -> Result<(), SlaveError> {
        self.enter("enter")
    }
    fn exit_initialization(&mut self) -> Result<(), SlaveError> {
        self.enter("exit")
    }
    fn do_step(&mut self, t: f64, h: f64) -> Result<(), SlaveError> {
        self.enter("step")?;
        (self.law)(&mut self.values, t, h);
        Ok(())
    }
    fn terminate(&mut self) -> Result<(), SlaveError> {
        self.enter("terminate")
    }
    fn reset(&mut self) -> Result<(), SlaveError> {
        self.enter("reset")?;
        self.values = self.first.clone();
        Ok(())
    }
    fn get_real(&mut self, refs: &[u32], values: &mut [f64]) -> Result<(), SlaveError> {
        self.get("get_real", refs, values, |v| v)
    }
    fn set_real(&mut self, refs: &[u32], values: &[f64]) -> Result<(), SlaveError> {
        self.set("set_real", refs, values.iter().copied())
    }
    fn get_integer(&mut self, refs: &[u32], values: &mut [i32]) -> Result<(), SlaveError> {
        self.get("get_integer", refs, values, |v| v as i32)
    }
    fn set_integer(&mut self, refs: &[u32], values: &[i32]) -> Result<(), SlaveError> {
        self.set("set_integer", refs, values.iter().map(|v| f64::from(*v)))
    }
    fn get_boolean(&mut self, refs: &[u32], values: &mut [bool]) -> Result<(), SlaveError> {
        self.get("get_boolean", refs, values, |v| v > 0.5)
    }
    fn set_boolean(&mut self, refs: &[u32], values: &[bool]) -> Result<(), SlaveError> {
        self.set("set_boolean", refs, values.iter().map(|v| f64::from(u8::from(*v))))
    }
    fn get_string(&mut self, refs: &[u32], values: &mut [String]) -> Result<(), SlaveError> {
        self.enter("get_string")?;
        for (r, v) in refs.iter().zip(values) {
            *v = self
                .texts
                .get(&self.ports[*r as usize].name)
                .cloned()
                .unwrap_or_default();
        }
        Ok(())
    }
    fn set_string(&mut self, refs: &[u32], values: &[String]) -> Result<(), SlaveError> {
        self.enter("set_string")?;
        for (r, v) in refs.iter().zip(values) {
            // Every text of the slave follows the one that was set.
            for port in &self.ports {
                self.texts.insert(port.name.clone(), v.clone());
            }
            self.texts.insert(self.ports[*r as usize].name.clone(), v.clone());
        }
        Ok(())
    }
}
