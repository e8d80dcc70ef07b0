#pragma once
/// \file The lock of the module.

namespace bough::python {

/// Holds the one lock of the module: MPI, PETSc and HDF5 serve one thread at a time. Recursive, since callbacks may
/// call the module again. Threads wait for it without the interpreter's lock, which the holder may need; so the two
/// are always taken in one order.
class Exclusive {
 public:
  /// Throws py::error_already_set if a Python signal handler raises while the main thread waits (Ctrl-C), unless
  /// `is_interruptible` is false.
  /// \pre this thread does not hold the interpreter's lock.
  explicit Exclusive(bool is_interruptible = true);
  ~Exclusive();
  Exclusive(const Exclusive&) = delete;
  Exclusive& operator=(const Exclusive&) = delete;
};

}  // namespace bough::python
