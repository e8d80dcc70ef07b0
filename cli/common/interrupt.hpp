#pragma once

namespace bough::cli {

/// SIGINT, SIGTERM and SIGHUP end the program with exit code 3 and leave no half-written file behind; a signal that was
/// ignored from the start stays so. In force before main() begins. Verbs that can stop in good order (run, batch) take
/// the signals over.
void end_cleanly_on_signals();

/// Of several ranks only the first says that it ends. Before main() the environment is not there yet.
void leave_word_to_first_rank();

/// A failure has been told: the signal with which mpirun ends the other ranks adds nothing.
void end_in_silence();

/// For such verbs: the three signals call `handler`; a hangup that was ignored (nohup) stays so.
void take_signals(void (*handler)(int));

/// Standard streams that the caller has closed lead to where every write fails, and not into the next file opened.
void secure_streams();

}  // namespace bough::cli
