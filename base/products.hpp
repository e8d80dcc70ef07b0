#pragma once
/// \file The kernels of Eigen's products and triangular solves, compiled once (base/instances/products.cpp): they are
/// no inline functions, so that `extern template` stops them; 40 kB of code a source. Part of the precompiled headers.
#include <Eigen/Dense>
#include <complex>

#ifndef BOUGH_PRODUCTS  // base/instances/products.cpp defines it as nothing
#define BOUGH_PRODUCTS extern
#endif

namespace Eigen::internal {

using BoughComplex = std::complex<double>;
using BoughTraits = gebp_traits<double, double>;
using BoughComplexTraits = gebp_traits<BoughComplex, BoughComplex>;
using BoughColumns = const_blas_data_mapper<double, Index, ColMajor>;
using BoughRows = const_blas_data_mapper<double, Index, RowMajor>;
using BoughResult = blas_data_mapper<double, Index, ColMajor>;
using BoughComplexColumns = const_blas_data_mapper<BoughComplex, Index, ColMajor>;
using BoughComplexRows = const_blas_data_mapper<BoughComplex, Index, RowMajor>;
using BoughComplexResult = blas_data_mapper<BoughComplex, Index, ColMajor>;

// Matrix by matrix.
BOUGH_PRODUCTS template struct gebp_kernel<double, double, Index, BoughResult, BoughTraits::mr, BoughTraits::nr>;
BOUGH_PRODUCTS template struct gebp_kernel<BoughComplex, BoughComplex, Index, BoughComplexResult,
                                           BoughComplexTraits::mr, BoughComplexTraits::nr>;
BOUGH_PRODUCTS template struct gemm_pack_lhs<double, Index, BoughColumns, BoughTraits::mr, BoughTraits::LhsProgress,
                                             BoughTraits::LhsPacket4Packing, ColMajor>;
BOUGH_PRODUCTS template struct gemm_pack_lhs<double, Index, BoughRows, BoughTraits::mr, BoughTraits::LhsProgress,
                                             BoughTraits::LhsPacket4Packing, RowMajor>;
BOUGH_PRODUCTS template struct gemm_pack_rhs<double, Index, BoughColumns, BoughTraits::nr, ColMajor>;
BOUGH_PRODUCTS template struct gemm_pack_rhs<double, Index, BoughRows, BoughTraits::nr, RowMajor>;
BOUGH_PRODUCTS template struct gemm_pack_rhs<double, Index, BoughResult, BoughTraits::nr, ColMajor, false, true>;
BOUGH_PRODUCTS template struct gemm_pack_rhs<double, Index, BoughColumns, BoughTraits::nr, ColMajor, false, true>;
BOUGH_PRODUCTS template struct gemm_pack_rhs<double, Index, BoughRows, BoughTraits::nr, RowMajor, false, true>;
BOUGH_PRODUCTS template struct general_matrix_matrix_product<Index, double, ColMajor, false, double, ColMajor, false,
                                                             ColMajor, 1>;
BOUGH_PRODUCTS template struct general_matrix_matrix_product<Index, double, RowMajor, false, double, ColMajor, false,
                                                             ColMajor, 1>;
BOUGH_PRODUCTS template struct general_matrix_matrix_product<Index, double, ColMajor, false, double, RowMajor, false,
                                                             ColMajor, 1>;

// Matrix by vector.
BOUGH_PRODUCTS template struct general_matrix_vector_product<Index, double, BoughColumns, ColMajor, false, double,
                                                             BoughRows, false>;
BOUGH_PRODUCTS template struct general_matrix_vector_product<Index, double, BoughColumns, ColMajor, false, double,
                                                             BoughColumns, false>;
BOUGH_PRODUCTS template struct general_matrix_vector_product<Index, double, BoughRows, RowMajor, false, double,
                                                             BoughColumns, false>;
BOUGH_PRODUCTS template struct general_matrix_vector_product<Index, double, BoughRows, RowMajor, false, double,
                                                             BoughRows, false, 1>;
BOUGH_PRODUCTS template struct general_matrix_vector_product<Index, BoughComplex, BoughComplexColumns, ColMajor, false,
                                                             BoughComplex, BoughComplexRows, false>;
BOUGH_PRODUCTS template struct general_matrix_vector_product<Index, BoughComplex, BoughComplexRows, RowMajor, false,
                                                             BoughComplex, BoughComplexColumns, false>;

// Triangles.
BOUGH_PRODUCTS template struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor, 1>;
BOUGH_PRODUCTS template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, 1>;
BOUGH_PRODUCTS template struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor, ColMajor,
                                                       1>;
BOUGH_PRODUCTS template struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, RowMajor, ColMajor, 1>;
BOUGH_PRODUCTS template struct triangular_solve_matrix<double, Index, OnTheLeft, UnitUpper, false, RowMajor, ColMajor,
                                                       1>;
BOUGH_PRODUCTS template struct product_triangular_matrix_matrix<double, Index, Lower, true, ColMajor, false, ColMajor,
                                                                false, ColMajor, 1>;
BOUGH_PRODUCTS template struct product_triangular_matrix_matrix<double, Index, UnitLower, true, ColMajor, false,
                                                                ColMajor, false, ColMajor, 1>;
BOUGH_PRODUCTS template struct product_triangular_matrix_matrix<double, Index, Upper, true, RowMajor, false, ColMajor,
                                                                false, ColMajor, 1>;
BOUGH_PRODUCTS template struct product_triangular_matrix_matrix<double, Index, UnitUpper, true, RowMajor, false,
                                                                ColMajor, false, ColMajor, 1>;
BOUGH_PRODUCTS template struct triangular_matrix_vector_product<Index, UnitUpper, double, false, double, false,
                                                                RowMajor>;
BOUGH_PRODUCTS template struct triangular_solve_vector<double, double, Index, OnTheLeft, Lower, false, ColMajor>;
BOUGH_PRODUCTS template struct triangular_solve_vector<double, double, Index, OnTheLeft, Upper, false, ColMajor>;
BOUGH_PRODUCTS template struct triangular_solve_vector<double, double, Index, OnTheLeft, UnitLower, false, ColMajor>;
BOUGH_PRODUCTS template struct selfadjoint_matrix_vector_product<double, Index, ColMajor, Lower, false, false>;

}  // namespace Eigen::internal
