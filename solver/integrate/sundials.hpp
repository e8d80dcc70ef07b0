#pragma once
/// \file Owners of SUNDIALS handles; included by .cpp files of this folder only.
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>

#include "base/diagnostic.hpp"
#include "solver/integrate/integrator.hpp"

namespace bough::solver::detail {

/// Rejections of one step by the error test before it counts as stalled: at a kink of a force steps get ever shorter.
inline constexpr int kMaxRejections = 40;

/// Context for one process. From SUNDIALS 7 on it owns the error handlers: without one, messages are in the exception
/// alone, and the logger of warnings writes nothing (see silence_messages for older versions).
class Context {
 public:
#if SUNDIALS_VERSION_MAJOR >= 7
  Context() {
    BOUGH_DEMAND(SUNContext_Create(SUN_COMM_NULL, &context_) == 0);
    BOUGH_DEMAND(SUNContext_ClearErrHandlers(context_) == 0);
    SUNLogger logger = nullptr;
    BOUGH_DEMAND(SUNContext_GetLogger(context_, &logger) == 0);
    if (logger != nullptr) BOUGH_DEMAND(SUNLogger_SetWarningFilename(logger, "/dev/null") == 0);
  }
#else
  Context() { BOUGH_DEMAND(SUNContext_Create(nullptr, &context_) == 0); }
#endif
  ~Context() { SUNContext_Free(&context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  /// The context, owned by this.
  operator SUNContext() const { return context_; }

 private:
  SUNContext context_ = nullptr;
};

class Vector {
 public:
  /// Vector of `size` numbers in the memory of this process, not initialized.
  Vector(int size, SUNContext context) : v_(N_VNew_Serial(size, context)) { BOUGH_DEMAND(v_ != nullptr); }
  ~Vector() { N_VDestroy(v_); }
  Vector(const Vector&) = delete;
  Vector& operator=(const Vector&) = delete;
  /// The vector, owned by this.
  operator N_Vector() const { return v_; }
  /// View of the numbers, to read and write.
  Eigen::Map<VectorXd> values() const { return {N_VGetArrayPointer(v_), N_VGetLength(v_)}; }

 private:
  N_Vector v_;
};

/// The right-hand side in SUNDIALS' form. A failure is "recoverable": the method first tries a smaller step.
inline int call_ode(sunrealtype t, N_Vector y, N_Vector y_dot, void* user) {
  return static_cast<GuardedOde*>(user)->calc(t, N_VGetArrayPointer(y), N_VGetArrayPointer(y_dot));
}

/// Messages go into the exception, not to the terminal. Returns SUNDIALS' flag, 0 if it took the handler.
#if SUNDIALS_VERSION_MAJOR >= 7
inline int silence_messages(void*) { return 0; }
#else
/// Handler of SUNDIALS 6 and older.
inline int silence_messages(void* cvode) {
  return CVodeSetErrHandlerFn(
      cvode, [](int, const char*, const char*, char*, void*) {}, nullptr);
}
#endif

}  // namespace bough::solver::detail
