// Laws of the user in C, C++ and Fortran (data/examples/controllers) against the same law of our own blocks.
#include <filesystem>
#include <stdexcept>

#include "base/foreign_call.hpp"
#include "solver/builder/build_system.hpp"
#include "solver/control/hosted.hpp"
#include "solver/control/user_code.hpp"
#include "tests/solver/control/support.hpp"

namespace bough::solver::testing {
namespace {

using ::testing::HasSubstr;

records::SystemSpec make_library(const std::string& file) {
  auto spec = make_axis();
  spec.hinges[0].position = {0.3};
  spec.controllers = {make_law("law", "library", {"angle", "rate"}, {{"parameters", {8, 1.6, 0.05}}})};
  spec.controllers[0].settings.words["file"] = {file};
  return spec;
}

TEST(Library, LawsInCAndFortranGiveTheHistoryOfOurOwnBlocks) {
  auto own = make_library("");
  own.controllers[0] = make_law("law", "state_space", {"angle", "rate"});
  auto& m = own.controllers[0].settings.matrices;
  m["A"] = MatrixXd::Constant(1, 1, -20);
  m["B"] = (MatrixXd(1, 2) << 0, 20).finished();
  m["C"] = MatrixXd::Constant(1, 1, -1.6);
  m["D"] = (MatrixXd(1, 2) << -8, 0).finished();
  const MatrixXd expected = run(own).sink.get("/sensors/angle");
  int found = 0;
  for (const char* file : {BOUGH_LAW_C, BOUGH_LAW_CPP, BOUGH_LAW_F}) {
    if (!std::filesystem::exists(file)) continue;
    ++found;
    const RunResult r = run(make_library(file));
    EXPECT_LT((r.sink.get("/sensors/angle") - expected).cwiseAbs().maxCoeff(), 1e-11) << file;
  }
  EXPECT_GE(found, 2);
}

TEST(Library, AnExceptionEndsTheRunByName) {
  auto spec = make_library(BOUGH_LAW_CPP);
  spec.hinges[0].rate = {30};
  const Diagnostic failure = run_to_failure(spec)[0];
  EXPECT_EQ(failure.id, "control.library-failed");
  EXPECT_THAT(failure.what, HasSubstr("controller 'law': bough_controller_outputs at t = "));
  EXPECT_THAT(failure.what, HasSubstr("beyond this law"));
}

TEST(Library, AFailureOfCloseIsOneOfTheRun) {
  ControllerFunctions f;
  int closed = 0;
  f.version = [] { return BOUGH_CONTROLLER_VERSION; };
  f.open = [](bough_controller*) { return 0; };
  f.outputs = [](void*, double, const double*, const double*, const double*, double* y) { return *y = 0, 0; };
  f.close = [&](void*) {
    ++closed;
    throw std::runtime_error("the log is full");
  };
  const HostedController lent("lent", f);
  const System system = build(make_library("lent"));
  try {
    close_user_blocks(system.signals);
    ADD_FAILURE() << "no failure";
  } catch (const Failure& failure) {
    EXPECT_EQ(failure.items()[0].id, "control.library-failed");
    EXPECT_EQ(failure.items()[0].what, "controller 'law': bough_controller_close threw: the log is full");
  }
  close_user_blocks(system.signals);
  EXPECT_EQ(closed, 1);
}

TEST(Library, TheCallInProgressIsDescribed) {
  ControllerFunctions f;
  std::string seen;
  f.language = "Python";
  f.version = [] { return BOUGH_CONTROLLER_VERSION; };
  f.open = [](bough_controller*) { return 0; };
  f.outputs = [&](void*, double, const double*, const double*, const double*, double* y) {
    seen = ForeignCall::find_current()->describe();
    return *y = 0, 0;
  };
  const HostedController lent("lent", f);
  run(make_library("lent"));
  EXPECT_THAT(seen, HasSubstr("controller 'law': outputs of its Python law at t = "));
  EXPECT_EQ(ForeignCall::find_current(), nullptr);
}

TEST(Library, RefusesWrongInputsAtOpening) {
  auto spec = make_library(BOUGH_LAW_C);
  spec.controllers[0].inputs = {"angle"};
  Diagnostics diagnostics;
  draft_system(spec, {}, diagnostics);
  EXPECT_TRUE(diagnostics.has("control.bad-library"));
}

}  // namespace
}  // namespace bough::solver::testing
