# flags.mk - what the bits of a result depend on, and what the libraries are called: for the Makefile, and for
# tools/cmake, which reads lines "NAME := words" and knows no more of make than that.

# Results must not depend on compiler or optimisation level: no contraction to fused
# multiply-add. The last two only give up errno and floating-point flags; values stay IEEE 754.
MATHS := -ffp-contract=off -fno-math-errno -fno-trapping-math

# The plain files are compiled for any machine of the kind, whatever -march CFLAGS ask for: the kernels
# choose their width when a world is made, and GCC 12 makes vfmaddsub of products and sums even when told
# not to contract.
BASELINE_X86_64 := -march=x86-64 -mno-fma

# A file X.simd.c is compiled once for every size of vector register, in floats.
WIDTHS := 4 8 16
WIDTH_8_X86_64 := -mavx2
WIDTH_16_X86_64 := -mavx512f -mavx512vl -mavx512dq -mavx512bw

VARIANTS := float double far
DEFS_double := -DPLUMB_DOUBLE=1
DEFS_far := -DPLUMB_FAR=1
SUFFIX_double := _d
SUFFIX_far := _far
