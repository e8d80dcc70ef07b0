#pragma once
/// \file One rank touches the disk, the others take what it found. Collective: every rank of an mpirun calls these
/// together. In a process that is alone they run the function and start no MPI.
#include <functional>
#include <string>

namespace bough::analysis {

/// Rank of this process by the environment of mpirun; 0 outside mpirun.
int get_launch_rank();

/// Returns true if mpirun started this process together with others.
bool is_one_of_many();

/// The bytes that `make` gives on the first rank, on every rank. A Failure thrown there is thrown on every rank, so
/// that all end with the same exit code and none waits for another.
std::string share(const std::function<std::string()>& make);
/// Runs `act` on the first rank only; a Failure is thrown on every rank.
void do_once(const std::function<void()>& act);
/// Waits until every process is here; whether it is true in all of them.
bool wait_for_all(bool is_true);

}  // namespace bough::analysis
