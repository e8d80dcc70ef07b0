// Errors of bough export --to fmu that the program itself cannot reach.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "analysis/export/export_fmu.hpp"
#include "base/diagnostic.hpp"
#include "formats/fmu/archive.hpp"
#include "formats/fmu/model_description.hpp"
#include "solver/control/hosted.hpp"

namespace bough {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kLent = R"([[body]]
name = "bob"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[hinge]]
name = "slide"
type = "prismatic"
child = "bob"
[[sensor]]
name = "x"
type = "position"
body = "bob"
[[controller]]
name = "law"
type = "library"
file = "lent"
inputs = ["x:x"]
outputs = 1
[simulation]
duration = 1.0
)";

TEST(ExportFmu, RefusesControllersOfTheHost) {
  const fs::path folder = fs::temp_directory_path() / ("bough-fmu-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "s.toml") << kLent;
  solver::ControllerFunctions f;
  f.language = "Python";
  f.version = [] { return BOUGH_CONTROLLER_VERSION; };
  f.open = [](bough_controller*) { return 0; };
  f.outputs = [](void*, double, const double*, const double*, const double*, double* y) { return *y = 0, 0; };
  const solver::HostedController lent((folder / "lent").string(), f);
  Diagnostics diagnostics;
  try {
    analysis::export_fmu((folder / "s.toml").string(), (folder / "a.fmu").string(), {}, diagnostics);
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.items()[0].id, "fmu.cannot-pack");
    EXPECT_THAT(error.items()[0].what, HasSubstr("[[controller]] 'law'"));
    EXPECT_EQ(error.items()[0].where.line, 13);
  }
  EXPECT_FALSE(fs::exists(folder / "a.fmu"));
  fs::remove_all(folder);
}

TEST(ExportFmu, AnArchiveThatCannotBeWrittenIsReported) {
  try {
    fmu::write_archive("/nowhere/a.fmu", {{"resources/a.txt", "text"}});
    ADD_FAILURE() << "no error";
  } catch (const ComputationError& error) {
    EXPECT_EQ(error.items()[0].id, "fmu.write");
    EXPECT_EQ(error.items()[0].where.file, "/nowhere/a.fmu");
  }
}

TEST(ModelDescription, IdentifiersAreThoseOfC) {
  EXPECT_EQ(fmu::make_identifier("arm"), "arm");
  EXPECT_EQ(fmu::make_identifier("2 arms-left"), "_2_arms_left");
  EXPECT_EQ(fmu::make_identifier("\xc3\xa4"), "__");
  EXPECT_EQ(fmu::make_identifier(""), "_");
}

TEST(ModelDescription, TextIsEscaped) {
  fmu::ModelDescription model;
  model.model_name = "a<b>&\"c\"\x01";
  model.identifier = "m";
  for (const auto& text : {fmu::format_fmi2(model), fmu::format_fmi3(model)})
    EXPECT_THAT(text, HasSubstr("modelName=\"a&lt;b&gt;&amp;&quot;c&quot;\""));
}

}  // namespace
}  // namespace bough
