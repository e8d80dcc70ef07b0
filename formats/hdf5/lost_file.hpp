#pragma once
/// \file A disk that fails while a file is closed.

namespace bough::hdf5 {

/// Whether a file could not be closed. The library writes it once more when it is ended, by MPI or at the exit, and
/// does not survive that: such a process leaves by _exit.
bool has_lost_file();
/// For the writers of this room.
void note_lost_file();

}  // namespace bough::hdf5
