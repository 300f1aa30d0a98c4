//! Slaves and the connections between them.

use std::collections::HashMap;
use std::fmt;

use fmi2_import::{Causality, Value, suggest};

use crate::units::{Relation, relation, unit_name};
use crate::{CosimError, Port, Slave, SlaveId};

/// An input that nothing feeds; it keeps its start value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnconnectedInput {
    /// The slave.
    pub slave: SlaveId,
    /// Its name.
    pub slave_name: String,
    /// The input.
    pub input: String,
}

impl fmt::Display for UnconnectedInput {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.slave_name, self.input)
    }
}

/// A slave with what the system knows of it.
pub(crate) struct Member {
    pub(crate) name: String,
    pub(crate) slave: Box<dyn Slave>,
    /// Ports under the names that wiring uses.
    pub(crate) ports: Vec<Port>,
    /// Position in `ports` by name, own names and aliases alike.
    index: HashMap<String, usize>,
    /// Port and value, in the order of setting.
    pub(crate) starts: Vec<(usize, Value)>,
}

/// A port by the positions of its slave and itself.
pub(crate) type PortAt = (usize, usize);

/// Slaves, their wiring and their start values.
///
/// The order of adding is the order of stepping.
#[derive(Default)]
pub struct System {
    pub(crate) members: Vec<Member>,
    /// Output and input; each input occurs once.
    pub(crate) connections: Vec<(PortAt, PortAt)>,
}

impl fmt::Debug for System {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<_> = self.members.iter().map(|m| &m.name).collect();
        f.debug_struct("System")
            .field("slaves", &names)
            .field("connections", &self.connections.len())
            .finish()
    }
}

impl System {
    /// A system without slaves.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a slave behind those already there.
    ///
    /// # Errors
    /// [`CosimError::DuplicateSlave`] or [`CosimError::DuplicateVariable`].
    pub fn add(&mut self, slave: Box<dyn Slave>) -> Result<SlaveId, CosimError> {
        let name = slave.name().to_owned();
        if self.members.iter().any(|m| m.name == name) {
            return Err(CosimError::DuplicateSlave { name });
        }
        let ports = slave.ports();
        let mut index = HashMap::with_capacity(ports.len());
        for (i, port) in ports.iter().enumerate() {
            if index.insert(port.name.clone(), i).is_some() {
                return Err(CosimError::DuplicateVariable {
                    slave: name,
                    variable: port.name.clone(),
                });
            }
        }
        self.members.push(Member {
            name,
            slave,
            ports,
            index,
            starts: Vec::new(),
        });
        Ok(SlaveId(self.members.len() - 1))
    }

    /// Lets the variable `own` take part in the wiring as `contract`, for slaves whose author chose other names. Both
    /// names are understood afterwards. Give aliases before connecting by name.
    ///
    /// # Errors
    /// [`CosimError::UnknownSlave`], [`CosimError::UnknownVariable`], or [`CosimError::DuplicateVariable`] if `contract`
    /// names another variable of the slave.
    pub fn alias(&mut self, slave: SlaveId, own: &str, contract: &str) -> Result<(), CosimError> {
        let (_, port) = self.locate(slave, own)?;
        let member = &mut self.members[slave.0];
        match member.index.get(contract) {
            Some(&taken) if taken != port => Err(CosimError::DuplicateVariable {
                slave: member.name.clone(),
                variable: contract.to_owned(),
            }),
            _ => {
                member.index.insert(contract.to_owned(), port);
                contract.clone_into(&mut member.ports[port].name);
                Ok(())
            }
        }
    }

    /// Connects every unfed input to the output of equal name of another slave, where there is one. Inputs that were
    /// connected explicitly stay as they are.
    ///
    /// * returns: the number of connections made.
    ///
    /// # Errors
    /// [`CosimError::SeveralSources`], [`CosimError::TypeMismatch`] or [`CosimError::UnitMismatch`]; then nothing is connected.
    pub fn connect_by_name(&mut self) -> Result<usize, CosimError> {
        let mut outputs: HashMap<&str, Vec<PortAt>> = HashMap::new();
        for (at, port) in self.ports_of(Causality::Output) {
            outputs.entry(&port.name).or_default().push(at);
        }
        let mut made = Vec::new();
        for (to, port) in self.ports_of(Causality::Input) {
            if self.source_of(to).is_some() {
                continue;
            }
            let mut sources = outputs.get(port.name.as_str()).into_iter().flatten();
            let Some(&from) = sources.next() else { continue };
            if let Some(&second) = sources.next() {
                return Err(self.several_sources(to, from, second));
            }
            self.check_types(from, to)?;
            made.push((from, to));
        }
        let count = made.len();
        self.connections.extend(made);
        Ok(count)
    }

    /// Connects every unfed input of one slave to the output of equal name of another, where there is one.
    ///
    /// * returns: the number of connections made.
    ///
    /// # Errors
    /// [`CosimError::TypeMismatch`] or [`CosimError::UnitMismatch`]; then nothing is connected.
    pub fn connect_by_name_from(&mut self, source: SlaveId, target: SlaveId) -> Result<usize, CosimError> {
        self.connect_by_name_where(source, target, |_| true)
    }

    /// The same of the names that are wanted.
    ///
    /// # Errors
    /// As for [`System::connect_by_name_from`].
    pub fn connect_by_name_where(
        &mut self,
        source: SlaveId,
        target: SlaveId,
        wanted: impl Fn(&str) -> bool,
    ) -> Result<usize, CosimError> {
        let outputs: HashMap<&str, PortAt> = self
            .ports_of(Causality::Output)
            .filter(|((slave, _), _)| *slave == source.0)
            .map(|(at, port)| (port.name.as_str(), at))
            .collect();
        let mut made = Vec::new();
        for (to, port) in self.ports_of(Causality::Input) {
            if to.0 != target.0 || self.source_of(to).is_some() || !wanted(&port.name) {
                continue;
            }
            if let Some(&from) = outputs.get(port.name.as_str()) {
                self.check_types(from, to)?;
                made.push((from, to));
            }
        }
        let count = made.len();
        self.connections.extend(made);
        Ok(count)
    }

    /// Connects one output to one input. To connect the same pair again changes nothing.
    ///
    /// # Errors
    /// [`CosimError::UnknownSlave`], [`CosimError::UnknownVariable`], [`CosimError::WrongCausality`],
    /// [`CosimError::TypeMismatch`], [`CosimError::UnitMismatch`] or [`CosimError::SeveralSources`].
    pub fn connect(&mut self, source: SlaveId, output: &str, target: SlaveId, input: &str) -> Result<(), CosimError> {
        let from = self.locate(source, output)?;
        let to = self.locate(target, input)?;
        self.check_causality(from, Causality::Output, "output")?;
        self.check_causality(to, Causality::Input, "input")?;
        self.check_types(from, to)?;
        match self.source_of(to) {
            None => self.connections.push((from, to)),
            Some(first) if first == from => {}
            Some(first) => return Err(self.several_sources(to, first, from)),
        }
        Ok(())
    }

    /// Inputs that nothing feeds, in the order of slaves and ports.
    #[must_use]
    pub fn unconnected_inputs(&self) -> Vec<UnconnectedInput> {
        self.ports_of(Causality::Input)
            .filter(|(at, _)| self.source_of(*at).is_none())
            .map(|((slave, _), port)| UnconnectedInput {
                slave: SlaveId(slave),
                slave_name: self.members[slave].name.clone(),
                input: port.name.clone(),
            })
            .collect()
    }

    /// Inputs of a slave that are fed values as they come, since their unit or that of what feeds them is not said.
    #[must_use]
    pub fn inputs_of_unknown_unit(&self, slave: SlaveId) -> Vec<&str> {
        let own = self.connections.iter().filter(|(_, to)| to.0 == slave.0);
        own.filter(|(from, to)| relation(self.port_at(*from), self.port_at(*to)) == Relation::Unknown)
            .map(|(_, to)| self.port_at(*to).name.as_str())
            .collect()
    }

    /// Gives a parameter or input a value to start from. It is kept and set in each run between setup and
    /// initialization, in the order of these calls; a second value for one variable replaces the first.
    ///
    /// # Errors
    /// [`CosimError::UnknownSlave`], [`CosimError::UnknownVariable`] or [`CosimError::WrongValueType`]. A value that the
    /// slave itself refuses fails in the run.
    pub fn set_start(&mut self, slave: SlaveId, variable: &str, value: Value) -> Result<(), CosimError> {
        let (_, at) = self.locate(slave, variable)?;
        let member = &mut self.members[slave.0];
        let port = &member.ports[at];
        if !value.fits(port.kind) {
            return Err(CosimError::WrongValueType {
                slave: member.name.clone(),
                variable: variable.to_owned(),
                expected: port.kind,
                given: value.base_type(),
                value: value.to_string(),
            });
        }
        match member.starts.iter_mut().find(|(known, _)| *known == at) {
            Some((_, old)) => *old = value,
            None => member.starts.push((at, value)),
        }
        Ok(())
    }

    /// Every port of a slave; none for a slave of another system.
    #[must_use]
    pub fn ports(&self, slave: SlaveId) -> &[Port] {
        self.members.get(slave.0).map_or(&[], |m| m.ports.as_slice())
    }

    /// The port of this name, if the slave has one.
    #[must_use]
    pub fn port(&self, slave: SlaveId, name: &str) -> Option<&Port> {
        let member = self.members.get(slave.0)?;
        member.index.get(name).map(|&at| &member.ports[at])
    }

    /// The name of a slave; empty for a slave of another system.
    #[must_use]
    pub fn name(&self, slave: SlaveId) -> &str {
        self.members.get(slave.0).map_or("", |m| m.name.as_str())
    }

    /// What a slave has logged since the last time, oldest first; nothing for a slave of another system.
    pub fn messages(&mut self, slave: SlaveId) -> Vec<String> {
        self.members
            .get_mut(slave.0)
            .map_or_else(Vec::new, |m| m.slave.messages())
    }

    /// Brings every slave back to where it was when it was made. Wiring and start values stay.
    ///
    /// # Errors
    /// [`CosimError::Reset`] for the first slave that cannot.
    pub fn reset(&mut self) -> Result<(), CosimError> {
        for member in &mut self.members {
            member.slave.reset().map_err(|error| CosimError::Reset {
                slave: member.name.clone(),
                error,
            })?;
        }
        Ok(())
    }

    fn ports_of(&self, causality: Causality) -> impl Iterator<Item = (PortAt, &Port)> {
        self.members.iter().enumerate().flat_map(move |(slave, member)| {
            let ports = member.ports.iter().enumerate();
            ports
                .filter(move |(_, p)| p.causality == causality)
                .map(move |(at, p)| ((slave, at), p))
        })
    }

    fn source_of(&self, input: PortAt) -> Option<PortAt> {
        self.connections
            .iter()
            .find(|(_, to)| *to == input)
            .map(|(from, _)| *from)
    }

    fn locate(&self, slave: SlaveId, name: &str) -> Result<PortAt, CosimError> {
        let member = self.members.get(slave.0).ok_or_else(|| self.unknown_slave(slave))?;
        member
            .index
            .get(name)
            .map(|&at| (slave.0, at))
            .ok_or_else(|| CosimError::UnknownVariable {
                slave: member.name.clone(),
                variable: name.to_owned(),
                suggestion: suggest(name, member.ports.iter().map(|p| p.name.as_str())),
            })
    }

    /// Refuses a slave of another system.
    pub(crate) fn known(&self, slave: SlaveId) -> Result<(), CosimError> {
        let member = self.members.get(slave.0).map(|_| ());
        member.ok_or_else(|| self.unknown_slave(slave))
    }

    /// The port of this name.
    pub(crate) fn known_port(&self, slave: SlaveId, name: &str) -> Result<&Port, CosimError> {
        self.locate(slave, name).map(|at| self.port_at(at))
    }

    fn unknown_slave(&self, slave: SlaveId) -> CosimError {
        CosimError::UnknownSlave {
            index: slave.0,
            count: self.members.len(),
        }
    }

    fn port_at(&self, (slave, at): PortAt) -> &Port {
        &self.members[slave].ports[at]
    }

    fn full_name(&self, at: PortAt) -> String {
        format!("{}.{}", self.members[at.0].name, self.port_at(at).name)
    }

    fn check_causality(&self, at: PortAt, wanted: Causality, expected: &'static str) -> Result<(), CosimError> {
        let port = self.port_at(at);
        if port.causality == wanted {
            return Ok(());
        }
        Err(CosimError::WrongCausality {
            slave: self.members[at.0].name.clone(),
            variable: port.name.clone(),
            found: port.causality,
            expected,
        })
    }

    fn check_types(&self, from: PortAt, to: PortAt) -> Result<(), CosimError> {
        let (source_type, input_type) = (self.port_at(from).kind, self.port_at(to).kind);
        if source_type == input_type {
            return self.check_units(from, to);
        }
        Err(CosimError::TypeMismatch {
            source_name: self.full_name(from),
            source_type,
            input: self.full_name(to),
            input_type,
        })
    }

    fn check_units(&self, from: PortAt, to: PortAt) -> Result<(), CosimError> {
        let (output, input) = (self.port_at(from), self.port_at(to));
        if relation(output, input) != Relation::Different {
            return Ok(());
        }
        Err(CosimError::UnitMismatch {
            source_name: self.full_name(from),
            source_unit: unit_name(output.unit.as_ref()),
            input: self.full_name(to),
            input_unit: unit_name(input.unit.as_ref()),
        })
    }

    fn several_sources(&self, input: PortAt, first: PortAt, second: PortAt) -> CosimError {
        CosimError::SeveralSources {
            input: self.full_name(input),
            first: self.full_name(first),
            second: self.full_name(second),
        }
    }
}
