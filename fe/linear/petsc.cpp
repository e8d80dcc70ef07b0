#include "fe/linear/petsc.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/diagnostic.hpp"

namespace bough::linear {

std::string get_petsc_message(PetscErrorCode code) {
  const char* text = nullptr;
  char* specific = nullptr;
  PetscErrorMessage(code, &text, &specific);
  std::string message = specific && *specific ? specific : text ? text : "no text";
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) message.pop_back();
  std::replace(message.begin(), message.end(), '\n', ' ');
  return message;
}

void check_petsc(PetscErrorCode code) {
  if (code == 0) return;
  const std::string own = " (code " + std::to_string(code) + " of the library: " + get_petsc_message(code) + ")";
  switch (code) {
    case PETSC_ERR_MEM:
      throw ComputationError("fe.out-of-memory", {}, "the matrices of the model do not fit the memory" + own,
                             "use a coarser mesh, ask for fewer modes, or run on more processes of a larger machine "
                             "(mpirun -n 2 bough ...)");
    case PETSC_ERR_ARG_OUTOFRANGE:
    case PETSC_ERR_SUP:
    case PETSC_ERR_INT_OVERFLOW:
      throw ComputationError("fe.petsc", {},
                             "the model is too large for the matrix library, or of a form it lacks" + own,
                             "use a coarser mesh, or run on more processes (mpirun -n 2 bough ...)");
    case PETSC_ERR_FP:
      throw ComputationError("fe.petsc", {}, "a number of the matrices overflows or is no number" + own,
                             "look for extreme or missing values in properties, materials and grids");
    default:
      throw ComputationError(
          "fe.petsc", {}, "the solver of linear equations and eigenvalues refuses the matrices of this model" + own,
          "look for parts that nothing holds, for masses and stiffness of extreme size and for negative springs; "
          "bough check names most of them");
  }
}

namespace {

template <class Function>
Function* find_function(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

/// One thread in CHOLMOD, and in OpenBLAS unless the user says otherwise: the factors' dense blocks are small, and
/// threads that wait for each other by spinning double the time on a busy machine and add a fifth on a quiet one. Two
/// parts of a model are work enough for two (threads.hpp). CHOLMOD asks OpenMP for a separate number of threads,
/// whatever OMP_NUM_THREADS says; no level of parallel regions means one. Found by name, since other libraries may be
/// installed.
void hold_threads() {
  set_openmp_levels(0);
  if (std::getenv("OPENBLAS_NUM_THREADS")) return;
  if (const auto set = find_function<void(int)>("openblas_set_num_threads")) set(1);
}

/// Chooses the transports of MPI, unless the user has set them. A process that no launcher started needs no daemon and
/// no network transport: making them ready takes ten times as long as the rest of its start (360 ms against 30 ms).
/// Ranks that are all on one machine need no network either: asking every kind of it takes 200 ms.
void choose_transport() {
  const auto get = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value ? value : "");
  };
  const std::string num_ranks = get("OMPI_COMM_WORLD_SIZE");
  const bool is_launched = !num_ranks.empty() || std::getenv("PMIX_RANK") || std::getenv("PMI_RANK");
  if (!is_launched || (!num_ranks.empty() && num_ranks == get("OMPI_COMM_WORLD_LOCAL_SIZE")))
    setenv("OMPI_MCA_pml", "ob1", 0);
  if (is_launched) return;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  setenv("OMPI_MCA_btl", "self", 0);
  // Nor a separate folder in /tmp, which processes that start at the same time fight over.
  setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
}

/// Points Open MPI and PMIx to the components that a release contains in the folder bough-openmpi next to libmpi. They
/// take precedence over the environment and the system, whose components belong to another library.
void use_bundled_mpi() {
  const auto start = find_function<int(int*, char***)>("MPI_Init");
  Dl_info info{};
  if (!start || dladdr(reinterpret_cast<void*>(start), &info) == 0 || !info.dli_fname) return;
  std::error_code failed;
  const auto folder = std::filesystem::canonical(info.dli_fname, failed).parent_path() / "bough-openmpi";
  if (failed || !std::filesystem::is_directory(folder, failed)) return;
  setenv("OPAL_PREFIX", folder.c_str(), 1);
  setenv("PMIX_PKGLIBDIR", (folder / "pmix").c_str(), 1);
  setenv("PMIX_PKGDATADIR", (folder / "share/pmix").c_str(), 1);
}

/// Open MPI puts a separate handler in the place of ours for a moment: a signal that comes then would be lost, and
/// waits instead.
PetscErrorCode initialize_undisturbed() {
  sigset_t held, before;
  sigemptyset(&held);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&held, signal);
  pthread_sigmask(SIG_BLOCK, &held, &before);
  int argc = 0;
  char** argv = nullptr;
  const PetscErrorCode code = PetscInitialize(&argc, &argv, nullptr, nullptr);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return code;
}

}  // namespace

int set_openmp_levels(int levels) {
  const auto set = find_function<void(int)>("omp_set_max_active_levels");
  const auto get = find_function<int()>("omp_get_max_active_levels");
  if (!set || !get) return levels;
  const int before = get();
  set(levels);
  return before;
}

MpiWorld initialize_petsc() {
  PetscBool initialized = PETSC_FALSE;
  PetscInitialized(&initialized);
  if (!initialized) {
    hold_threads();
    use_bundled_mpi();
    choose_transport();
    // A crash is Bough's to report, not PETSc's.
    PetscOptionsSetValue(nullptr, "-no_signal_handler", "true");
    check_petsc(initialize_undisturbed());
    PetscPushErrorHandler(PetscReturnErrorHandler, nullptr);
    std::atexit([] {
      PetscBool finalized = PETSC_FALSE;
      PetscFinalized(&finalized);
      if (!finalized) PetscFinalize();
    });
  }
  MpiWorld world;
  MPI_Comm_rank(PETSC_COMM_WORLD, &world.rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &world.size);
  return world;
}

}  // namespace bough::linear
