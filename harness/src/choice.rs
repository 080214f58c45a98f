//! A strategy that a command line asks for, ready to be made.

use assign::{
    AssignError, Fewer, FrustumTests, Gpu, Half, Keep, LightSource, PlainDepth, Reuse, Stochastic,
    Touched, Unordered,
};
use assign_clustered::SpecularCut;
use shading::Mode;

use crate::strategy::{Axis, IdError, Method, Role, Row, StrategyId};

/// A strategy that a command line asks for.
#[derive(Clone, Debug)]
pub struct Choice {
    row: &'static Row,
    id: StrategyId,
    /// Whether the command line names it, and does not ask for all strategies.
    pub is_named: bool,
    names_tests: bool,
    names_source: bool,
}

impl Choice {
    /// Reads an id such as `SC-E/48x48x40/bvh`; a family alone takes its default parameters.
    pub fn parse(id: &str) -> Result<Self, IdError> {
        let id = StrategyId::parse(id)?;
        let row = id.row().ok_or_else(|| IdError::Unknown { id: id.to_string() })?;
        let names_tests = id.options().tests.is_some();
        let names_source = id.options().source.is_some();
        Ok(Self { row, id, is_named: true, names_tests, names_source })
    }

    /// The same strategy with the tests and the source of an option, where its id names none.
    ///
    /// # Errors
    ///
    /// A source that contradicts the id.
    pub fn with(
        &self,
        tests: Option<FrustumTests>,
        source: Option<LightSource>,
    ) -> Result<Self, IdError> {
        let tests = tests.filter(|_| self.takes_tests());
        let source = source.filter(|_| self.takes_source());
        let id = self.id.with(|options| {
            options.tests = tests.or(options.tests);
            options.source = source.or(options.source);
        })?;
        Ok(Self { id, ..self.clone() })
    }

    /// Makes the method on a device, and checks its parameters.
    pub fn make(&self, gpu: &Gpu) -> Result<Method, AssignError> {
        let options = self.id.options();
        let mut method = (self.row.make)(gpu, options)?;
        if let Method::Lists { strategy, early_exit, .. } = &mut method {
            *early_exit &= !options.evaluates_all;
            // Which lights a cap drops from lists without an order is random, so they cap themselves.
            if let Some(most) = options.cap.filter(|_| !options.is_unordered) {
                strategy.lists_mut().cap_lists(most);
            }
        }
        let Method::Lists { mut strategy, early_exit, .. } = method else { return Ok(method) };
        if options.is_half {
            strategy = Box::new(Half::new(gpu, strategy)?);
        }
        if options.is_plain_depth {
            strategy = Box::new(PlainDepth::new(strategy));
        }
        if let Some(threshold) = options.stochastic {
            strategy = Box::new(Stochastic::new(gpu, strategy, threshold)?);
        }
        if let Some((kept, most)) = options.fewer {
            strategy = Box::new(Fewer::new(gpu, strategy, kept, most)?);
        }
        if options.is_touched {
            strategy = Box::new(Touched::new(gpu, strategy)?);
        }
        if let Some(frames) = options.keep {
            strategy = Box::new(Keep::new(gpu, strategy, frames)?);
        }
        if let Some(frames) = options.reuse {
            strategy = Box::new(Reuse::new(strategy, frames)?);
        }
        if options.is_unordered {
            strategy = Box::new(Unordered::new(gpu, strategy, options.cap)?);
        }
        let is_random = options.is_unordered || options.stochastic.is_some();
        Ok(Method::Lists { strategy, early_exit, stochastic: options.stochastic, is_random })
    }

    /// The canonical id.
    pub fn id(&self) -> &StrategyId {
        &self.id
    }

    /// The family's row.
    pub fn row(&self) -> &'static Row {
        self.row
    }

    /// Whether it may show another image than no culling of that many lights, because a knob says so.
    pub fn is_lossy(&self, lights: u64) -> bool {
        self.id.is_lossy(lights)
    }

    /// The most lights of a list.
    pub fn cap(&self) -> u32 {
        self.id.options().cap.unwrap_or(u32::MAX)
    }

    /// Whether area lights too dull over a group lose their specular term.
    pub fn is_specular_cut(&self) -> bool {
        matches!(self.id.options().specular, SpecularCut::Below(_))
    }

    /// Whether lists are used for several frames.
    pub fn is_reused(&self) -> bool {
        let options = self.id.options();
        options.is_touched
            || [options.reuse, options.keep].into_iter().flatten().any(|frames| frames > 1)
    }

    /// Whether its lists leave out lights that shadow maps hide.
    pub fn leaves_out_hidden(&self) -> bool {
        self.id.options().leaves_out_hidden
    }

    /// Whether it cuts the samples into groups, and so has something to assign.
    pub fn has_groups(&self) -> bool {
        self.row.has_groups
    }

    /// Whether it takes the tests of an option, because its id names none.
    pub fn takes_tests(&self) -> bool {
        self.row.has_axis(Axis::Tests) && !self.names_tests
    }

    /// Whether it takes the source of an option, because its id names none.
    pub fn takes_source(&self) -> bool {
        self.row.has_axis(Axis::Source) && !self.names_source
    }

    /// Whether it tests lights against the corners of frusta, and not only against their planes.
    pub fn tests_corners(&self) -> bool {
        self.id.tests().is_some_and(|tests| {
            FrustumTests { hs: true, ..tests } != FrustumTests { hs: true, ..NO_TESTS }
        })
    }

    /// Why it cannot light pixels in a mode; `None` where it can.
    pub fn refuses_mode(&self, mode: Mode) -> Option<&'static str> {
        self.row.refuses_mode(mode)
    }

    /// The largest relative difference of a channel that the method states about itself; `None` where
    /// no bit may differ.
    pub fn tolerance(&self) -> Option<f64> {
        self.row.tolerance
    }

    /// Whether it is the reference of all images.
    pub fn is_reference(&self) -> bool {
        self.row.role == Role::Baseline
    }

    /// Whether it leaves out lights before shading: all but no culling, with or without the early exit, and the
    /// control.
    pub fn culls(&self) -> bool {
        !matches!(self.row.role, Role::Baseline | Role::EarlyExit | Role::Control)
    }

    /// Whether it is the control, whose images are not compared.
    pub fn is_control(&self) -> bool {
        self.row.role == Role::Control
    }
}

/// No test at all.
const NO_TESTS: FrustumTests =
    FrustumTests { hs: false, sat_e: false, sat_n: false, sat_p: false, sat_v: false };
