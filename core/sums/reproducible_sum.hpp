// Sums over the grains of all ranks with the same bits for any distribution of the grains over ranks and in any order.
//
// Every term is turned into a 64-bit integer multiple of a power of two that is chosen from the largest term and the
// number of terms, so that the sum of integers, which is associative, cannot overflow. The rounding of one term is at
// most 2^-61 times the number of terms times the largest term.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace thalweg {

// terms: rows of `columns` values, one row a grain owned here (columns of a row together). Returns one sum a column,
// the same on every rank; NaN for a column that holds a term which is not finite. Collective.
std::vector<double> reproducible_sums(MPI_Comm communicator, std::span<const double> terms, std::size_t columns);

// Takes a row of terms, one a column, that belongs to a bin.
using TermTaker = std::function<void(int bin, std::span<const double> row)>;

// Sums by bins of rows that are not kept: rows(take) hands over the rows of this rank, any number of them, with bins in
// [0, bins). It is called twice, once for the largest terms and once for the sums, and hands over the same rows each
// time. Returns `columns` sums for each bin, bin by bin. Memory: two numbers a sum.
std::vector<double> reproducible_sums_by_bin(MPI_Comm communicator, int bins, std::size_t columns,
                                             const std::function<void(const TermTaker&)>& rows);

}  // namespace thalweg
