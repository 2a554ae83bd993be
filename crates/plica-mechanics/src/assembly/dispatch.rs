//! Selection of the compiled kernel for a law and a degree.

/// Calls a kernel that is compiled for the degree and for the law: neo-Hookean on processors with wide vectors, or any.
macro_rules! with_law_and_degree {
    ($self:ident, $law:expr, $($kernel:ident)::+, $($argument:expr),+) => {
        match &$law {
            Material::NeoHookean(law) if crate::tensor::has_wide_vectors() => {
                with_degree!($self, $($kernel)::+ <_>, law, $($argument),+)
            }
            law => with_degree!($self, $($kernel)::+ <_>, law, $($argument),+),
        }
    };
}

/// Calls a kernel that is compiled for N = p + 1 functions per direction.
macro_rules! with_degree {
    ($self:ident, $($kernel:ident)::+ $(<$law:tt>)?, $($argument:expr),+) => {
        match $self.degree() {
            1 => $($kernel)::+::<$($law,)? 2>($($argument),+),
            2 => $($kernel)::+::<$($law,)? 3>($($argument),+),
            3 => $($kernel)::+::<$($law,)? 4>($($argument),+),
            4 => $($kernel)::+::<$($law,)? 5>($($argument),+),
            5 => $($kernel)::+::<$($law,)? 6>($($argument),+),
            degree => unreachable!("SplineTube::new refuses degree {degree}"),
        }
    };
}

pub(super) use {with_degree, with_law_and_degree};
