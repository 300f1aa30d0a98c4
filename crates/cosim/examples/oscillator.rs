//! An oscillator of two slaves in plain Rust, x' = y and y' = -x, under both coupling schemes.
//!
//! `cargo run -p cosim --example oscillator`

use std::error::Error;
use std::io::Write;
use std::ops::ControlFlow;
use std::sync::mpsc;

use cosim::Causality::{Input, Output};
use cosim::{BaseType, Causality, CosimError, Port, RunOptions, Scheme, Slave, SlaveError, System};

/// Plain Rust in the place of an FMU: some numbers, and what a step of `h` seconds does with them.
struct Mock<F> {
    name: &'static str,
    ports: Vec<Port>,
    values: Vec<f64>,
    law: F,
}

fn mock<F: FnMut(&mut [f64], f64)>(name: &'static str, variables: &[(&str, Causality, f64)], law: F) -> Box<Mock<F>> {
    let port = |(reference, (name, causality, _)): (u32, &(&str, Causality, f64))| {
        Port::new(*name, reference, BaseType::Real, *causality)
    };
    Box::new(Mock {
        name,
        ports: (0..).zip(variables).map(port).collect(),
        values: variables.iter().map(|(.., start)| *start).collect(),
        law,
    })
}

impl<F: FnMut(&mut [f64], f64) + Send> Slave for Mock<F> {
    fn name(&self) -> &str {
        self.name
    }

    fn ports(&self) -> Vec<Port> {
        self.ports.clone()
    }

    fn do_step(&mut self, _t: f64, h: f64) -> Result<(), SlaveError> {
        (self.law)(&mut self.values, h);
        Ok(())
    }

    fn get_real(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), SlaveError> {
        for (reference, value) in references.iter().zip(values) {
            *value = self.values[*reference as usize];
        }
        Ok(())
    }

    fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), SlaveError> {
        for (reference, value) in references.iter().zip(values) {
            self.values[*reference as usize] = *value;
        }
        Ok(())
    }
}

/// Position, velocity and energy as a slave that only listens meets them in each step.
fn oscillate(scheme: Scheme, options: &RunOptions) -> Result<Vec<[f64; 3]>, CosimError> {
    let (sender, seen) = mpsc::channel();
    let mut system = System::new();
    let first = [("y", Input, 0.0), ("x", Output, 1.0)];
    system.add(mock("first", &first, |v, h| v[1] += h * v[0]))?;
    let second = [("x", Input, 0.0), ("y", Output, 0.0)];
    system.add(mock("second", &second, |v, h| v[1] -= h * v[0]))?;
    let meter = [("x", Input, 0.0), ("y", Input, 0.0)];
    system.add(mock("meter", &meter, move |v, _| {
        // Nobody listens any more when the run is over.
        let _ = sender.send([v[0], v[1], v[0] * v[0] + v[1] * v[1]]);
    }))?;
    system.connect_by_name()?;
    let options = RunOptions { scheme, ..*options };
    let report = system.run(&options, |_| ControlFlow::<()>::Continue(()))?;
    debug_assert!(report.isolated.is_empty());
    Ok(seen.try_iter().collect())
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = RunOptions {
        stop: 10.0,
        step: 0.1,
        ..RunOptions::default()
    };
    let one_by_one = oscillate(Scheme::GaussSeidel, &options)?;
    let at_once = oscillate(Scheme::Jacobi, &options)?;

    let mut out = std::io::stdout().lock();
    writeln!(out, "{:>6}  {:^26}  {:^26}", "", "Gauss-Seidel", "Jacobi")?;
    let head = format!("{:>8} {:>8} {:>8}", "x", "y", "energy");
    writeln!(out, "{:>6}  {head}  {head}", "step")?;
    let every = 10;
    for (k, (gs, j)) in one_by_one
        .iter()
        .zip(&at_once)
        .enumerate()
        .skip(every - 1)
        .step_by(every)
    {
        let row = |v: &[f64; 3]| format!("{:8.4} {:8.4} {:8.4}", v[0], v[1], v[2]);
        writeln!(out, "{:6}  {}  {}", k + 1, row(gs), row(j))?;
    }
    Ok(())
}
