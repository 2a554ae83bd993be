//! Selection of the vector instructions of the processor, at run time.

/// Evaluates an expression with the widest vectors of the processor, as a token that implements
/// [`Simd`](fearless_simd::Simd).
///
/// On x86 the code is compiled for AVX-512, for AVX2 and for SSE2, which every 64-bit processor has.
/// `fearless_simd::dispatch` would compile it for SSE4.2 as well: a quarter of the build time, for processors made
/// before 2013. With `wide if CONDITION` code that is constant and true leaves SSE2 out as well: its caller asks
/// [`has_wide_vectors`] first. Unit tests are compiled for AVX2 only, in a third of the time.
macro_rules! with_vectors {
    ($simd:ident => $operation:expr) => {
        $crate::tensor::with_vectors!(wide if false, $simd => $operation)
    };
    (wide if $wide:expr, $simd:ident => $operation:expr) => {{
        let level = fearless_simd::Level::new();
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        {
            use fearless_simd::Simd as _;
            if !cfg!(test)
                && let Some($simd) = level.as_avx512()
            {
                $simd.vectorize(
                    #[inline(always)]
                    || $operation,
                )
            } else if let Some($simd) = level.as_avx2() {
                $simd.vectorize(
                    #[inline(always)]
                    || $operation,
                )
            } else if $wide || cfg!(test) {
                unreachable!("a processor with AVX2")
            } else {
                let $simd = level.as_sse2().expect("64-bit x86 has SSE2");
                $simd.vectorize(
                    #[inline(always)]
                    || $operation,
                )
            }
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        {
            fearless_simd::dispatch!(level, $simd => $operation)
        }
    }};
}

/// Returns whether the processor has vectors of at least four numbers, or is not an x86.
pub fn has_wide_vectors() -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    let wide = fearless_simd::Level::new().as_avx2().is_some();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    let wide = true;
    wide
}

pub(crate) use with_vectors;
