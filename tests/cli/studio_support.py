"""A running `bough studio` and requests to it."""
import json
import subprocess
import urllib.error
import urllib.request

from support import HANG, PROGRAM, ProgramTest


class StudioTest(ProgramTest):
    def start_studio(self, *arguments, folder=None):
        """Starts it in the folder of the test; address and process are in the object."""
        self.studio = subprocess.Popen([PROGRAM, "studio", "--no-open", *arguments], cwd=folder or self.folder, text=True,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(self.end_studio)
        self.address = self.studio.stdout.readline().strip()
        self.assertRegex(self.address, r"^http://127\.0\.0\.1:\d+/[0-9a-f]{32}/$", self.studio.poll())
        self.origin = self.address.split("/")[0] + "//" + self.address.split("/")[2]

    def check_page(self, browser):
        """Nothing failed in the page; the icon of the tab is not there."""
        self.assertEqual([e for e in browser.list_errors() if "favicon" not in e], [])

    def end_studio(self):
        if self.studio.poll() is None:
            self.studio.terminate()
        self.studio.communicate(timeout=HANG)

    def request(self, path, data=None, headers=None, address=None):
        """Status, headers and body; data are sent by POST as the page sends them."""
        own = {} if data is None else {"Origin": self.origin, "Content-Type": "application/json"}
        request = urllib.request.Request((address or self.address) + path, data=data, headers={**own, **(headers or {})})
        try:
            with urllib.request.urlopen(request, timeout=HANG) as answer:
                return answer.status, answer.headers, answer.read()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.headers, error.read()

    def call(self, name, **body):
        status, _, text = self.request("api/" + name, json.dumps(body).encode())
        self.assertEqual(status, 200, text)
        return json.loads(text)

    def ask(self, what, **more):
        """The result of a request; it must succeed."""
        answer = self.call("ask", what=what, **more)
        self.assertIn("result", answer, answer)
        return answer["result"]

    def refuses(self, error, what, **more):
        """The request must fail with this id."""
        answer = self.call("ask", what=what, **more)
        self.assertNotIn("result", answer)
        self.assertIn(error, [m["id"] for m in answer["messages"]], answer)
        return answer["messages"]

    def run_job(self, verb, files, *options):
        """Exit code and output of a command that the page starts."""
        job = self.call("start", verb=verb, files=files, options=list(options))
        self.assertIn("result", job, job)
        state = {"running": True}
        while state["running"]:
            state = self.call("job", job=job["result"]["job"])["result"]
        return state["code"], state["output"], job["result"]["line"]
