#pragma once
/// \file Two threads for what is worth them.
#include <cstddef>
#include <functional>

namespace bough::linear {

/// OMP_NUM_THREADS, or two if the machine has them; one if there are several ranks, or under ulimit -v.
int get_num_threads();

/// Both at once, the second in a separate thread; OpenMP starts none beside them. What either throws is thrown here.
void do_both(const std::function<void()>& first, const std::function<void()>& second);
/// The same of one alone, in this thread.
void do_alone(const std::function<void()>& work);

/// work(first, last) of 0 to `size`: two halves at once where there are two threads and more than `least` for each.
void do_halves(int size, int least, const std::function<void(int, int)>& work);
/// The same of the columns of an array, where it has rows enough.
void do_columns(std::ptrdiff_t rows, std::ptrdiff_t columns, const std::function<void(int, int)>& work);

}  // namespace bough::linear
