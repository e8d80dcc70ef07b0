"""cmake --install into a fresh folder, then a find_package(Bough) project is configured, built and run against it."""
import os
import subprocess
import sys
import tempfile

ROOT, BUILD = sys.argv[1:3]
# Templates of Eigen take half the time without optimization, and each program here runs for a moment.
PLAIN = "-DCMAKE_CXX_FLAGS_RELEASE=-O0"


def run(*command, **options):
    print("$", " ".join(command), flush=True)
    return subprocess.run(command, check=True, text=True, **options)


with tempfile.TemporaryDirectory() as folder:
    prefix, build = os.path.join(folder, "prefix"), os.path.join(folder, "build")
    run("cmake", "--install", BUILD, "--prefix", prefix, stdout=subprocess.DEVNULL)
    run("cmake", "-G", "Ninja", "-S", os.path.join(ROOT, "tests/install/consumer"), "-B", build,
        f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release", PLAIN)
    run("cmake", "--build", build)
    printed = run(os.path.join(build, "consumer"), os.path.join(ROOT, "tests/install/consumer/pendulum.toml"),
                  stdout=subprocess.PIPE).stdout
    print(printed)
    time, angle = (float(word) for word in printed.split())
    # A rigid pendulum of 1 m and 1 kg released from 0.1 rad; one small-swing period is 2 pi sqrt(1/9.81) = 2.00607 s,
    # longer by the factor 1 + angle^2/16, and it comes back to where it started.
    assert abs(time - 2.00732) < 1e-9, time
    assert abs(angle - 0.1) < 1e-4, angle
    # The first bending mode of the boom, of EI = 566.64 N m2 and 1.61543 kg in 8 m: 1.8751^2 sqrt(EI / (m L^3)) / 2 pi.
    printed = run(os.path.join(build, "modes"), os.path.join(ROOT, "data/examples/ex01-spinup/boom.bdf"),
                  stdout=subprocess.PIPE).stdout
    assert abs(float(printed) / 0.463175 - 1) < 1e-4, printed
    # The example hosts, as an outside project that knows of libbough.so alone: by CMake and by pkg-config.
    hosts, build = os.path.join(prefix, "share/bough/examples/hosts"), os.path.join(folder, "hosts")
    system = os.path.join(hosts, "system.toml")
    text = run("cmake", "-G", "Ninja", "-S", hosts, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}",
               "-DCMAKE_BUILD_TYPE=Release", PLAIN, stdout=subprocess.PIPE).stdout
    assert "PETSc" not in text and "hdf5" not in text.lower(), text
    run("cmake", "--build", build)
    printed = run(os.path.join(build, "host_c"), system, stdout=subprocess.PIPE).stdout
    assert len(printed.splitlines()) == 6, printed
    programs = [[os.path.join(build, name)] for name in ("host_cpp", "host_f") if os.path.exists(os.path.join(build, name))]
    library = [os.path.join(base, name) for base, _, names in os.walk(prefix) for name in names if name == "libbough.so.1"][0]
    environment = {**os.environ, "BOUGH_LIBRARY": library, "LD_LIBRARY_PATH": os.path.dirname(library),
                   "PKG_CONFIG_PATH": os.path.join(os.path.dirname(library), "pkgconfig")}
    flags = run("pkg-config", "--cflags", "--libs", "bough", stdout=subprocess.PIPE, env=environment).stdout.split()
    run("cc", os.path.join(hosts, "host.c"), "-o", os.path.join(folder, "host"), *flags)
    programs += [[os.path.join(folder, "host")], [sys.executable, "-B", os.path.join(hosts, "host.py")]]
    for program in programs:
        assert run(*program, system, stdout=subprocess.PIPE, env=environment).stdout == printed, program
    bough = os.path.join(prefix, "bin", "bough")
    assert "bough" in run(bough, "--version", stdout=subprocess.PIPE).stdout
    for name, words in [("man/man1/bough.1", ".SS bough reduce"), ("man/man1/bough-reduce.1", ".SH OPTIONS"),
                        ("bash-completion/completions/bough", "complete "),
                        ("zsh/vendor-completions/_bough", "#compdef bough"),
                        ("fish/vendor_completions.d/bough.fish", "complete -c bough")]:
        with open(os.path.join(prefix, "share", name)) as f:
            assert words in f.read(), name
    share = os.path.join(prefix, "share", "bough")
    assert os.path.exists(os.path.join(share, "examples/ex01-spinup/boom.bdf")), share
    headers = [os.path.join(base, name) for base, _, names in os.walk(os.path.join(prefix, "include")) for name in names]
    assert headers and not [h for h in headers if "/detail/" in h], "detail headers are installed"
print("ok")
