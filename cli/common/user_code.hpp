#pragma once
/// \file Protection of the program against user libraries that crash or end the process.

namespace bough::cli {

/// From the first call into a user library on, a crash, exit() or abort() within one is reported by the name of the
/// controller and ends the process with exit code 3. Everything else crashes and exits as before, by the handlers that
/// the process had. For the program and the Python module; libbough.so leaves the handlers to its host.
void guard_user_code();

/// Reports and ends the process with exit code 3 if this process, not a child forked by a library, is within a user
/// library. `call`: the function that ended it, as "_exit()". Async-signal-safe.
void end_if_in_user_code(const char* call) noexcept;

/// Ends the process without handlers of exit(); never taken for the doing of a library. Async-signal-safe.
[[noreturn]] void leave_at_once(int code) noexcept;

}  // namespace bough::cli
