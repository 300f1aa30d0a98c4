//! What an FMI 3.0 FMU shows of itself on a drawing: its icon, and its ports gathered into terminals that are connected whole.

use fmi2_import::{Causality, ModelDescription};
use interface::ports::{self, Port, Role, Shape};

use super::documentation::escape;

/// Some ports under one name.
struct Terminal {
    name: &'static str,
    /// How members are matched: `plug`, each on either side has its partner, or `bus`, those that both sides have.
    rule: &'static str,
    about: &'static str,
    has: fn(&Port) -> bool,
}

/// Every terminal; an FMU has those of which it has a port.
const TERMINALS: [Terminal; 5] = [
    Terminal {
        name: "sensors",
        rule: "plug",
        about: "what the chaser's sensors say, and what the filter begins with: from the world to the filter",
        has: |port| port.role == Role::Sensor,
    },
    Terminal {
        name: "commands",
        rule: "bus",
        about: "accelerations and impulses of the chaser: from guidance to the world, and to a filter that is to know of them",
        has: |port| port.role == Role::Command,
    },
    Terminal {
        name: "attitude",
        rule: "bus",
        about: "attitude that the chaser is to hold: from guidance to the world",
        has: |port| port.role == Role::Attitude,
    },
    Terminal {
        name: "disturbances",
        rule: "bus",
        about: "what pushes the target and nobody announces: from life support to the world",
        has: |port| port.role == Role::Disturbance,
    },
    Terminal {
        name: "estimate",
        rule: "bus",
        about: "estimate, prediction, uncertainty and state of the filter: from the filter to guidance",
        has: |port| port.role == Role::Estimate,
    },
];

/// Whether an FMU has this port as an input or output.
fn offers(d: &ModelDescription, port: &Port) -> bool {
    let element = match port.shape {
        Shape::Scalar => port.name.to_owned(),
        Shape::Vector(_) => format!("{}[1]", port.name),
        Shape::Matrix(..) => format!("{}[1,1]", port.name),
    };
    d.get(&element)
        .is_some_and(|variable| matches!(variable.causality, Causality::Input | Causality::Output))
}

/// The file `terminalsAndIcons/terminalsAndIcons.xml` of the twin of an FMU.
pub(super) fn xml(d: &ModelDescription) -> String {
    let mut text = String::from(concat!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n",
        "<fmiTerminalsAndIcons fmiVersion=\"3.0\">\n",
        "  <GraphicalRepresentation>\n",
        "    <CoordinateSystem x1=\"-100\" y1=\"-100\" x2=\"100\" y2=\"100\" suggestedScalingFactorTo_mm=\"0.1\"/>\n",
        "    <Icon x1=\"-100\" y1=\"-100\" x2=\"100\" y2=\"100\"/>\n",
        "  </GraphicalRepresentation>\n",
        "  <Terminals>\n",
    ));
    for terminal in &TERMINALS {
        let members: Vec<&Port> = ports::PORTS
            .iter()
            .filter(|port| (terminal.has)(port) && offers(d, port))
            .collect();
        if members.is_empty() {
            continue;
        }
        text.push_str(&format!(
            "    <Terminal name=\"{}\" matchingRule=\"{}\" description=\"{}\">\n",
            terminal.name,
            terminal.rule,
            escape(terminal.about)
        ));
        for port in members {
            text.push_str(&format!(
                "      <TerminalMemberVariable variableName=\"{0}\" memberName=\"{0}\" variableKind=\"signal\"/>\n",
                escape(port.name)
            ));
        }
        text.push_str("    </Terminal>\n");
    }
    text.push_str("  </Terminals>\n</fmiTerminalsAndIcons>\n");
    text
}
