//! What a wrapper leaves to the strategy that it wraps.

/// Defines the named methods of [`Assignment`](crate::Assignment) as those of the field `inner`. A wrapper names what it
/// forwards, and writes what it changes. `lists` stands for `lists_mut` too. Methods with a default body, such as
/// `specular_reach`, keep that default unless they are named.
#[macro_export]
macro_rules! leave_to_inner {
    (@needs) => {
        fn needs(&self) -> $crate::Needs {
            self.inner.needs()
        }
    };
    (@is_view_bound) => {
        fn is_view_bound(&self) -> bool {
            self.inner.is_view_bound()
        }
    };
    (@updates_groups) => {
        fn updates_groups(&self) -> bool {
            self.inner.updates_groups()
        }
    };
    (@specular_reach) => {
        fn specular_reach(&self) -> f32 {
            self.inner.specular_reach()
        }
    };
    (@compile) => {
        fn compile(
            &mut self,
            gpu: &$crate::Gpu,
            lights: $crate::LightTraits,
        ) -> ::core::result::Result<(), $crate::AssignError> {
            self.inner.compile(gpu, lights)
        }
    };
    (@prepare) => {
        fn prepare(
            &mut self,
            gpu: &$crate::Gpu,
            frame: &$crate::Frame<'_>,
        ) -> ::core::result::Result<(), $crate::AssignError> {
            self.inner.prepare(gpu, frame)
        }
    };
    (@record) => {
        fn record(&mut self, frame: &$crate::Frame<'_>, passes: &mut dyn $crate::Passes) {
            self.inner.record(frame, passes);
        }
    };
    (@lookup) => {
        fn lookup(&self) -> $crate::Lookup<'_> {
            self.inner.lookup()
        }
    };
    (@bind_group) => {
        fn bind_group(&self) -> ::core::option::Option<&$crate::wgpu::BindGroup> {
            self.inner.bind_group()
        }
    };
    (@lists) => {
        fn lists(&self) -> &$crate::LightLists {
            self.inner.lists()
        }

        fn lists_mut(&mut self) -> &mut $crate::LightLists {
            self.inner.lists_mut()
        }
    };
    (@memory_bytes) => {
        fn memory_bytes(&self) -> u64 {
            self.inner.memory_bytes()
        }
    };
    ($($method:ident),+ $(,)?) => {
        $($crate::leave_to_inner!(@$method);)+
    };
}
