#pragma once
/// \file Two threads for what is worth them.
#include <cstddef>
#include <functional>

namespace bough::linear {

/// OMP_NUM_THREADS, or two if the machine has them; one if there are several ranks, or under ulimit -v.
int get_num_threads();

/// Both at once, the second in a separate thread; OpenMP starts no others. What either throws is thrown here.
void do_both(const std::function<void()>& first, const std::function<void()>& second);
/// Runs one piece of work in this thread.
void do_alone(const std::function<void()>& work);

/// work(first, last) of 0 to `size`: two halves at once where there are two threads and more than `min_size` for each.
void do_halves(int size, int min_size, const std::function<void(int, int)>& work);
/// Runs do_halves over the columns of an array if it has enough rows.
void do_columns(std::ptrdiff_t rows, std::ptrdiff_t columns, const std::function<void(int, int)>& work);

}  // namespace bough::linear
