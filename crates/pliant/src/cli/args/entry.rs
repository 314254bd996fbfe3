//! `--entry METHOD[:R|:FILE|:PARAMETERS]`: one way to bend the mesh.

use std::fmt;
use std::str::FromStr;

use pliant_solver::{DeformationGraph, Method as Solved};

use super::Method;
use crate::cli::failure::Failure;

/// One way to bend the mesh, as named on the command line.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) struct Entry {
    /// As it was typed.
    text: String,
    pub(in crate::cli) way: Way,
}

/// A method with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::cli) enum Way {
    /// With so many rings, or those that a file names, as the option `--rigidity` has it; none: those of the mesh.
    Rring(Option<String>),
    Arap,
    SrArap {
        alpha: f64,
    },
    Embedded {
        nodes: usize,
        node_neighbors: usize,
    },
}

impl Entry {
    pub(in crate::cli) fn method(&self) -> Method {
        match self.way {
            Way::Rring(_) => Method::Rring,
            Way::Arap => Method::Arap,
            Way::SrArap { .. } => Method::SrArap,
            Way::Embedded { .. } => Method::Embedded,
        }
    }

    /// The file that says how rigid the mesh is.
    pub(in crate::cli) fn file(&self) -> Option<&str> {
        match &self.way {
            Way::Rring(Some(rigidity)) if rigidity.parse::<i128>().is_err() => Some(rigidity),
            _ => None,
        }
    }

    /// Refuses parameters out of range.
    pub(in crate::cli) fn check(&self) -> Result<(), Failure> {
        let refuse = |option, value: String, allowed| Err(Failure::OutOfRange { option, value, allowed });
        match self.way {
            Way::SrArap { alpha } if !(alpha >= 0.0 && alpha.is_finite()) => {
                refuse("alpha of --entry", alpha.to_string(), "a number of at least 0")
            }
            Way::Embedded { nodes, .. } if !DeformationGraph::NODES.contains(&nodes) => {
                refuse("nodes of --entry", nodes.to_string(), "from 1 to 20000")
            }
            Way::Embedded { node_neighbors: k, .. } if !DeformationGraph::NEIGHBORS.contains(&k) => {
                refuse("node-neighbors of --entry", k.to_string(), "from 2 to 16")
            }
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl FromStr for Entry {
    type Err = String;

    fn from_str(text: &str) -> Result<Entry, String> {
        let (method, more) = match text.split_once(':') {
            Some((method, more)) => (method, Some(more)),
            None => (text, None),
        };
        if more == Some("") {
            return Err(format!("nothing follows the colon; use {method} alone, or say what"));
        }
        let way = match method {
            "rring" => Way::Rring(more.map(str::to_owned)),
            "arap" if more.is_some() => {
                return Err("arap is rigidity 1 everywhere and takes nothing; use rring:R".into());
            }
            "arap" => Way::Arap,
            "sr-arap" => sr_arap(more)?,
            "embedded" => embedded(more)?,
            _ => return Err(format!("there is no method {method:?}; use rring, arap, sr-arap or embedded")),
        };
        Ok(Entry { text: text.to_owned(), way })
    }
}

fn sr_arap(more: Option<&str>) -> Result<Way, String> {
    let mut alpha = Solved::ALPHA;
    for (key, value) in parameters(more) {
        match key {
            "alpha" => alpha = number(key, value)?,
            _ => return Err("sr-arap takes alpha=NUMBER and nothing else".into()),
        }
    }
    Ok(Way::SrArap { alpha })
}

fn embedded(more: Option<&str>) -> Result<Way, String> {
    let (mut nodes, mut node_neighbors) = (Solved::NODES, Solved::NODE_NEIGHBORS);
    for (key, value) in parameters(more) {
        match key {
            "nodes" => nodes = number(key, value)?,
            "node-neighbors" => node_neighbors = number(key, value)?,
            _ => return Err("embedded takes nodes=NUMBER, node-neighbors=NUMBER and nothing else".into()),
        }
    }
    Ok(Way::Embedded { nodes, node_neighbors })
}

/// `key=value` between commas; without `=` the key is all of it.
fn parameters(more: Option<&str>) -> impl Iterator<Item = (&str, &str)> {
    let words = more.into_iter().flat_map(|more| more.split(','));
    words.map(|word| word.split_once('=').unwrap_or((word, "")))
}

fn number<T: FromStr>(key: &str, value: &str) -> Result<T, String> {
    value.parse().map_err(|_| format!("{value:?} is not a number that {key} could be"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn way(text: &str) -> Result<Way, String> {
        text.parse().map(|entry: Entry| entry.way)
    }

    #[test]
    fn entries_say_a_method_and_what_it_takes() {
        assert_eq!(way("rring"), Ok(Way::Rring(None)));
        assert_eq!(way("rring:6"), Ok(Way::Rring(Some("6".into()))));
        assert_eq!(way("arap"), Ok(Way::Arap));
        assert_eq!(way("sr-arap"), Ok(Way::SrArap { alpha: 0.02 }));
        assert_eq!(way("sr-arap:alpha=1e-3"), Ok(Way::SrArap { alpha: 1e-3 }));
        assert_eq!(way("embedded"), Ok(Way::Embedded { nodes: 500, node_neighbors: 4 }));
        assert_eq!(way("embedded:node-neighbors=6"), Ok(Way::Embedded { nodes: 500, node_neighbors: 6 }));
        let both = "embedded:node-neighbors=6,nodes=9";
        assert_eq!(way(both), Ok(Way::Embedded { nodes: 9, node_neighbors: 6 }));
        let entry: Entry = both.parse().expect("legal");
        assert_eq!((entry.to_string(), entry.method()), (both.to_owned(), Method::Embedded));
    }

    #[test]
    fn files_are_told_from_numbers() {
        let file = |text: &str| text.parse::<Entry>().expect("legal").file().map(str::to_owned);
        assert_eq!([file("rring"), file("rring:6"), file("rring:-1"), file("arap")], [None, None, None, None]);
        assert_eq!(file("rring:C:\\r.json"), Some("C:\\r.json".into()));
    }

    #[test]
    fn what_no_method_takes_is_refused() {
        for (text, word) in [
            ("", "rring, arap"),
            ("ARAP", "no method"),
            ("rring:", "colon"),
            ("arap:2", "use rring:R"),
            ("sr-arap:0.02", "alpha=NUMBER"),
            ("sr-arap:alpha=soft", "soft"),
            ("embedded:nodes=-1", "nodes"),
            ("embedded:nodes=9,alpha=1", "nothing else"),
        ] {
            let said = way(text).expect_err(text);
            assert!(said.contains(word), "{text}: {said}");
        }
    }

    #[test]
    fn parameters_out_of_range_are_refused() {
        for text in ["sr-arap:alpha=-1", "sr-arap:alpha=nan", "embedded:nodes=0", "embedded:nodes=20001"] {
            assert!(text.parse::<Entry>().expect("numbers").check().is_err(), "{text}");
        }
        assert!("embedded:node-neighbors=17".parse::<Entry>().expect("a number").check().is_err());
        assert!("embedded:nodes=20000,node-neighbors=2".parse::<Entry>().expect("numbers").check().is_ok());
    }
}
