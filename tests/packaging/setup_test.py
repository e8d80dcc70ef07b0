"""Output of ./dev while it installs and builds (tools/setup.sh), with programs in place of apt, dpkg and cmake."""
import os
import subprocess
import tempfile
import unittest

SOURCE = os.environ["BOUGH_SOURCE_DIR"]
FAILS = """echo 'pmstatus:libx:10.0:Unpacking libx'
echo 'Err:3 main amd64 liby 404'
echo 'E: Unable to fetch some archives'
exit 100"""
WORKS = """[ "$1" = install ] || exit 0
echo 'dlstatus:1:50.0000:Retrieving file 1 of 2'
echo 'pmstatus:libx:50.0000:Unpacking libx'
echo 'pmstatus:libx:100.0000:Installed libx'"""


class Setup(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        for name in ("bash", "cat", "env", "grep", "mktemp", "rm", "tail"):
            os.symlink(os.path.join("/usr/bin", name), os.path.join(self.folder, name))
        self.put("id", "echo 0")

    def put(self, name, script):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as f:
            f.write("#!/usr/bin/bash\n" + script + "\n")
        os.chmod(path, 0o755)

    def run_script(self, script):
        return subprocess.run(["/usr/bin/bash", "-euo", "pipefail", "-c", f". {SOURCE}/tools/setup.sh\n{script}"], text=True,
                              capture_output=True, env={"PATH": self.folder, "TMPDIR": self.folder})

    def test_packages_that_are_there_need_no_root(self):
        self.put("id", "echo 1000")
        self.put("dpkg-query", "echo install ok installed")
        done = self.run_script('m="$(list_missing a b)"; [ -z "$m" ] || install_packages $m')
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_systems_without_dpkg_go_on_to_cmake(self):
        done = self.run_script('m="$(list_missing a b)"; [ -z "$m" ] || install_packages $m')
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_no_root_and_no_sudo_names_the_command(self):
        self.put("id", "echo 1000")
        self.put("dpkg-query", "case $* in *there) echo install ok installed ;; *) exit 1 ;; esac")
        done = self.run_script('m="$(list_missing there libx liby)"; install_packages $m || exit')
        self.assertEqual(done.returncode, 3)
        self.assertIn("apt-get install --no-install-recommends libx liby", done.stderr)

    def test_failure_of_apt_is_shown(self):
        self.put("apt-get", FAILS)
        done = self.run_script("install_packages libx liby || exit")
        self.assertEqual(done.returncode, 3)
        self.assertIn("E: Unable to fetch some archives", done.stderr)
        self.assertIn("Err:3 main amd64 liby 404", done.stderr)
        self.assertIn("error: apt could not install libx liby", done.stderr)

    def test_progress_of_apt(self):
        self.put("apt-get", WORKS)
        done = self.run_script("install_packages libx liby || exit")
        self.assertEqual(done.returncode, 0, done.stderr)
        shown = [line.split(",")[0] for line in done.stderr.strip().split("\n")]
        self.assertEqual(shown, [f"installing 2 packages: {n} %" for n in (25, 75, 100)])

    def test_a_terminal_shows_the_package(self):
        self.put("apt-get", WORKS)
        done = subprocess.run(["/usr/bin/script", "-qec", f"/usr/bin/bash -c '. {SOURCE}/tools/setup.sh; install_packages libx'",
                               "/dev/null"], text=True, capture_output=True, env={"PATH": self.folder, "TMPDIR": self.folder})
        self.assertIn("installing 1 package: 75 %", done.stdout)
        self.assertIn(", Unpacking libx\033[K", done.stdout)

    def test_progress_of_the_build(self):
        self.put("cmake", "for n in 1 2 3 4; do echo \"[$n/4] Building x\"; done; echo 'a.cpp:1: warning: w'")
        done = self.run_script(f"build_all {self.folder} -j 2")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = done.stderr.strip().split("\n")
        self.assertEqual([line.split(",")[0] for line in lines[:-1]], [f"building: {n} %" for n in (25, 50, 75, 100)])
        self.assertIn("about 1 min left", lines[0])
        self.assertEqual(lines[-1], f"1 warnings of the compiler, in {self.folder}/build.log")

    def test_failure_of_the_build_is_shown(self):
        self.put("cmake", "echo '[1/4] Building a'; echo 'FAILED: b.o'; echo 'b.cpp:3: error: no'; exit 1")
        done = self.run_script(f"build_all {self.folder}")
        self.assertEqual(done.returncode, 1)
        self.assertIn("b.cpp:3: error: no", done.stderr)
        self.assertIn("build.log", done.stderr)

    def test_failure_of_cmake_is_shown(self):
        self.put("cmake", """echo '[0/1] Re-running CMake...'; echo 'CMake Error at CMakeLists.txt:3 (find_package):'
echo '  Could not find x'; echo 'FAILED: build.ninja'; exit 1""")
        done = self.run_script(f"build_all {self.folder}")
        self.assertEqual(done.returncode, 1)
        self.assertIn("Could not find x", done.stderr)


if __name__ == "__main__":
    unittest.main()
