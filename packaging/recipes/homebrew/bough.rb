# Formula of Homebrew, on Linux: HOMEBREW_BOUGH_SOURCE=$PWD/bough-0.3.0.tar.gz brew install --formula ./bough.rb
# Not run: the machines of the project have no Homebrew. Homebrew's petsc has neither MUMPS nor CHOLMOD (docs/install.md),
# so that this builds the multibody solver and libbough.so alone. On macOS see docs/install.md.
class Bough < Formula
  desc "Flexible multibody solver: libbough with its C and C++ interface"
  url "file://#{ENV.fetch("HOMEBREW_BOUGH_SOURCE", "/bough-0.3.0.tar.gz")}"
  version "0.3.0"
  license "BSD-3-Clause"

  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "eigen"
  depends_on "fmt"
  depends_on "muparser"
  depends_on "nlohmann-json"
  depends_on "sundials"
  depends_on "tomlplusplus"

  def install
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", "-DBOUGH_SOLVER_ONLY=ON", "-DBOUGH_BUILD_TESTS=OFF",
           *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    cp pkgshare/"examples/hosts/host.c", testpath
    system ENV.cc, "host.c", "-I#{include}", "-L#{lib}", "-lbough", "-o", "host"
    system "./host", pkgshare/"examples/hosts/system.toml"
  end
end
