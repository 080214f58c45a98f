//! Negative controls of a strategy's own shader: the same strategy with other WESL.

use crate::{AssignError, Assignment, Gpu, Lookup, StrategyModule, StrategyWesl, leave_to_inner};

/// A strategy whose look-up has other text, to plant faults in it.
pub struct Reworded {
    inner: Box<dyn Assignment>,
    module: StrategyModule,
}

impl Reworded {
    /// Gives `inner` the WESL of `reword`, which gets the strategy's own. Its kernels stay as they are.
    pub fn new(
        inner: Box<dyn Assignment>,
        reword: impl FnOnce(StrategyWesl<'static>) -> StrategyWesl<'static>,
    ) -> Self {
        let wesl = reword(inner.lookup().module.wesl());
        // SAFETY: tests replace words, and leave the loops as they are.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { StrategyModule::new(wesl) };
        Self { inner, module }
    }
}

/// `text` with `part` replaced by `other`, for the rest of the program's life.
///
/// # Panics
///
/// Panics if the text does not hold the part.
pub fn reword(text: &str, part: &str, other: &str) -> &'static str {
    assert!(text.contains(part), "the text has no {part:?}");
    text.replace(part, other).leak()
}

/// WESL whose look-ups trust their groups also in shaders that [look up
/// anywhere](crate::Shader::looks_up_anywhere).
pub fn trusting(wesl: StrategyWesl<'static>) -> StrategyWesl<'static> {
    // This flag is off in look-ups.
    let blind = |text: &str| -> &'static str { text.replace("anywhere", "multisampled").leak() };
    let imports: Vec<_> = wesl.imports.iter().map(|(path, text)| (*path, blind(text))).collect();
    StrategyWesl { main: blind(wesl.main), imports: imports.leak(), ..wesl }
}

impl Assignment for Reworded {
    fn id(&self) -> String {
        self.inner.id()
    }

    leave_to_inner!(
        needs,
        is_view_bound,
        specular_reach,
        compile,
        prepare,
        record,
        bind_group,
        lists,
        memory_bytes
    );

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self { inner: self.inner.for_view(gpu)?, module: self.module }))
    }

    fn lookup(&self) -> Lookup<'_> {
        Lookup { module: self.module, ..self.inner.lookup() }
    }
}
