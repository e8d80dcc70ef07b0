"""The page of the studio after a failed run and with files of odd names."""
import os
import unittest

from studio_control_test import SYSTEM
from studio_page import PageTest


class Systems(PageTest):
    def show_system(self, text=SYSTEM):
        self.write("sliders.toml", text)
        self.start_studio("sliders.toml")
        self.browser.visit(self.address)
        self.wait("document.querySelector('.text-pane')?.dataset.checked === '0'")

    def command(self, text):
        self.browser.click("input.command")
        self.browser.type(text + "\n")
        self.wait("document.querySelector('input.command').value === ''")

    def save(self):
        self.wait("document.querySelector('dialog pre.diff')")
        self.click_text("Save", "document.querySelector('dialog')")

    def test_a_failed_run_says_whose_results_are_shown(self):
        self.show_system()
        page = self.browser
        page.click("button.run")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        self.assertFalse(page.run("document.querySelector('.result .banner') !== null"))
        self.command("set simulation.output_step=5")
        page.click("button.run")
        self.save()
        self.wait("document.querySelector('.result').dataset.ready === 'old'")
        self.assertIn("wrote no results", page.run("document.querySelector('.result .banner').textContent"))

    def test_the_value_of_a_parameter_that_is_gone(self):
        self.show_system()
        page = self.browser
        page.run("""(() => { const field = document.querySelector('[aria-label="parameter gain"]');
          field.value = "7"; field.dispatchEvent(new Event("change")); })()""")
        self.assertEqual(page.run("studio.view.list_set()"), ["gain=7"])
        self.command("set pid.kp=5.0")
        self.command("unset parameters.gain")
        self.wait("studio.view.set.size === 0")

    def test_results_have_another_name_than_the_file_of_that_name(self):
        self.write("sliders.toml", SYSTEM)
        self.bough("linearize", "sliders.toml", "-o", "sliders.h5")
        before = self.read_bytes("sliders.h5")
        self.show_system()
        page = self.browser
        page.run("new Promise((done) => setTimeout(done, 500))")
        self.assertEqual(page.run("document.querySelector('.notes').textContent"), "")
        page.click("button.run")
        self.wait("document.querySelector('.result').dataset.ready === 'true'")
        self.assertTrue(os.path.exists(self.path("sliders-run.h5")))
        self.assertEqual(self.read_bytes("sliders.h5"), before)

    def read_bytes(self, name):
        with open(self.path(name), "rb") as f:
            return f.read()


if __name__ == "__main__":
    unittest.main()
