#pragma once
/// \file A disk that fails while a file is closed.

namespace bough::hdf5 {

/// Returns true if a file could not be closed. The library writes it again when it is ended, by MPI or at the exit, and
/// crashes: such a process must leave by _exit.
bool has_lost_file();
/// For the writers of this room.
void note_lost_file();

}  // namespace bough::hdf5
