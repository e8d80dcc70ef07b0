#include "analysis/common/ranks.hpp"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "base/diagnostic.hpp"
#include "fe/linear/petsc.hpp"

namespace bough::analysis {

namespace {

/// From the first rank to all; in pieces, for MPI counts in int.
void broadcast(std::string& bytes) {
  unsigned long long size = bytes.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, PETSC_COMM_WORLD);
  bytes.resize(size);
  constexpr unsigned long long kPiece = 1ull << 30;
  for (unsigned long long at = 0; at < size; at += kPiece)
    MPI_Bcast(bytes.data() + at, static_cast<int>(std::min(kPiece, size - at)), MPI_BYTE, 0, PETSC_COMM_WORLD);
}

std::string to_text(const Failure& failure) {
  nlohmann::json json{{"exit_code", failure.exit_code()}, {"items", nlohmann::json::array()}};
  for (const auto& item : failure.items())
    json["items"].push_back({static_cast<int>(item.severity), item.id, item.where.file, item.where.line,
                             item.where.column, item.what, item.advice});
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

[[noreturn]] void throw_failure(const std::string& text) {
  const auto json = nlohmann::json::parse(text);
  std::vector<Diagnostic> items;
  for (const auto& item : json["items"])
    items.push_back(
        {static_cast<Severity>(item[0].get<int>()), item[1], {item[2], item[3], item[4]}, item[5], item[6]});
  if (json["exit_code"] == 1) throw InputError(std::move(items));
  throw ComputationError(std::move(items));
}

}  // namespace

int get_launch_rank() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"}) {
    if (const char* value = std::getenv(name)) return std::atoi(value);
  }
  return 0;
}

bool is_one_of_many() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* value = std::getenv(name)) return std::atoi(value) > 1;
  // The only variable of srun --mpi=pmix; a job without srun has no rank.
  const char* tasks = std::getenv("SLURM_STEP_NUM_TASKS");
  return std::getenv("PMIX_RANK") != nullptr && tasks != nullptr && std::atoi(tasks) > 1;
}

std::string share(const std::function<std::string()>& make) {
  if (!is_one_of_many()) return make();
  std::string bytes, failed;
  if (linear::initialize_petsc().rank == 0) {
    try {
      bytes = make();
    } catch (const Failure& failure) {
      failed = to_text(failure);
    } catch (const std::exception& error) {
      failed = to_text(ComputationError({}, {}, error.what(), "the first process of the run reports it"));
    }
  }
  broadcast(failed);
  if (!failed.empty()) throw_failure(failed);
  broadcast(bytes);
  return bytes;
}

bool wait_for_all(bool is_true) {
  if (!is_one_of_many()) return is_true;
  int all = 0;
  const int own = is_true ? 1 : 0;
  linear::initialize_petsc();
  MPI_Allreduce(&own, &all, 1, MPI_INT, MPI_MIN, PETSC_COMM_WORLD);
  return all != 0;
}

void do_once(const std::function<void()>& act) {
  share([&] {
    act();
    return std::string();
  });
}

}  // namespace bough::analysis
