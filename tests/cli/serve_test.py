"""manoscope serve: what the program does around the server; the server itself is tested in C++.

Usage: serve_test.py PROGRAM [unittest arguments]
"""

import http.client
import json
import os
import pathlib
import signal
import subprocess
import time

from support import Folder, PROGRAM, TAUT_MEMBRANE, main, run

SCENARIO = TAUT_MEMBRANE + """[fluid]
viscosity = "1 mPa s"
density = "998 kg/m3"
[hydrostatic]
levels = ["0 Pa", "500 Pa", "1 kPa", "2 kPa", "4 kPa", "6 kPa", "8 kPa"]
[flow]
flow_rates = ["2 mL/min", "5 mL/min"]
outlet_pressure = "300 Pa"
"""


class Served:
    """A server of a folder, and a browser that was let in."""

    def __init__(self, folder, *options, before=None):
        self.process = subprocess.Popen([PROGRAM, "serve", folder, "--json", "--no-browser", *options],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                        preexec_fn=before)
        told = json.loads(self.process.stdout.readline())
        self.port, self.url = told["port"], told["url"]
        self.cookie = ""
        answer, _ = self.ask("GET", self.url[self.url.index("/?"):])
        self.cookie = answer.headers["Set-Cookie"].split(";")[0]

    def ask(self, method, path, content=None, **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        body = None if content is None else json.dumps(content)
        headers |= {"Cookie": self.cookie, "Origin": f"http://127.0.0.1:{self.port}"}
        if body is not None:
            headers["Content-Type"] = "application/json"
        connection.request(method, path, body, headers)
        answer = connection.getresponse()
        text = answer.read()
        connection.close()
        is_json = answer.headers.get("Content-Type") == "application/json"
        return answer, json.loads(text) if is_json else text

    def job(self):
        return self.ask("GET", "/api/jobs/current")[1]["job"]

    def wait_for_job(self):
        for _ in range(1200):
            job = self.job()
            if job["state"] != "running":
                return job
            time.sleep(0.1)
        raise AssertionError(job)

    def end(self):
        self.process.send_signal(signal.SIGINT)
        self.process.communicate(timeout=30)
        return self.process.returncode

    def close(self):
        if self.process.poll() is None:
            self.end()
        self.process.stdout.close()
        self.process.stderr.close()


def children_of(parent):
    """Processes that a process has started and that still run."""
    children = []
    for path in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            after_name = path.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # it has ended
        if int(after_name[1]) == parent and after_name[0] != "Z":
            children.append(int(path.parent.name))
    return children


def runs(process):
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


class Words(Folder):
    def test_ends_at_ctrl_c_as_if_it_was_asked_to(self):
        served = Served(self.folder)
        self.addCleanup(served.close)
        self.assertEqual(served.end(), 0)

    def test_ends_with_its_terminal(self):
        served = Served(self.folder)
        self.addCleanup(served.close)
        served.process.send_signal(signal.SIGHUP)
        served.process.send_signal(signal.SIGHUP)  # shell and system both tell of it
        served.process.communicate(timeout=30)
        self.assertEqual(served.process.returncode, 0)

    def test_goes_on_without_its_terminal_where_it_was_told_to(self):
        served = Served(self.folder, before=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.addCleanup(served.close)
        served.process.send_signal(signal.SIGHUP)
        self.assertEqual(served.ask("GET", "/api/state")[0].status, 200)

    def test_a_folder_is_served_at_the_same_port_again(self):
        ports = set()
        for _ in range(2):
            served = Served(self.folder)
            self.addCleanup(served.close)
            ports.add(served.port)
            served.end()
        self.assertEqual(len(ports), 1)

    def test_a_folder_that_is_not_there_is_the_users_fault(self):
        self.assertIn("absent", run("serve", self.folder / "absent", check_code=2).stderr)
        self.assertIn("--port", run("serve", self.folder, "--port", "x", check_code=2).stderr)
        self.assertIn("--port", run("serve", self.folder, "--port", "70000", check_code=2).stderr)

    def test_takes_the_port_that_is_asked_for_and_tells_one_that_is_taken(self):
        served = Served(self.folder)
        self.addCleanup(served.close)
        done = run("serve", self.folder, "--port", served.port, check_code=2)
        self.assertIn(f"port {served.port}", done.stderr)

    def test_prints_the_address_alone(self):
        process = subprocess.Popen([PROGRAM, "serve", self.folder], stdout=subprocess.PIPE,
                                   stderr=subprocess.DEVNULL, text=True)
        self.assertRegex(process.stdout.readline(), r"^http://127\.0\.0\.1:\d+/\?token=[0-9a-f]{64}$")
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.communicate(timeout=30)[0], "")
        self.assertEqual(process.returncode, 0)


class Measuring(Folder):
    def setUp(self):
        super().setUp()
        (self.folder / "taut.toml").write_text(SCENARIO)
        self.out = self.folder / "served"
        run("twin", self.folder / "taut.toml", "-o", self.out / "experiment", check_code=0)

    def serve(self):
        served = Served(self.out)
        self.addCleanup(served.close)
        return served

    def test_measures_as_the_command_line_does(self):
        served = self.serve()
        _, state = served.ask("GET", "/api/state")
        self.assertEqual([e["file"] for e in state["experiments"]], ["experiment/experiment.toml"])
        order = {"experiment": "experiment/experiment.toml", "output": "again",
                 "options": {"nonlocal": "no", "interactive": "no"}}
        answer, _ = served.ask("POST", "/api/jobs", order)
        self.assertEqual(answer.status, 202)
        self.assertEqual(served.ask("POST", "/api/jobs", order)[0].status, 409)
        job = served.wait_for_job()
        self.assertEqual((job["state"], job["fraction"]), ("done", 1.0), job["log"])
        self.assertTrue(job["stage"])
        out = self.folder / "by-hand"
        done = run("measure", self.out / "experiment", "-o", out, "--nonlocal", "no", "--json",
                   check_code=0)
        result = served.ask("GET", "/api/result?folder=again")[1]
        told = json.loads(done.stdout)
        for key in ("checks", "improve_first", "uncertainties", "warnings"):
            self.assertEqual(result[key], told[key], key)
        for one, other in zip(result["runs"], told["runs"], strict=True):
            self.assertEqual({key: one[key] for key in other}, other)
        self.assertEqual((self.out / "again/result.nc").read_bytes(), (out / "result.nc").read_bytes())
        report, _ = served.ask("GET", "/results/again/report.html")
        self.assertIn("sandbox", report.headers["Content-Security-Policy"])

    def test_cancels_and_leaves_nothing(self):
        served = self.serve()
        served.ask("POST", "/api/jobs", {"experiment": "experiment/experiment.toml", "output": "cut"})
        while not served.job()["stage"]:
            time.sleep(0.02)
        self.assertEqual(served.ask("DELETE", "/api/jobs/current")[0].status, 202)
        self.assertEqual(served.wait_for_job()["state"], "cancelled")
        self.assertFalse((self.out / "cut/result.nc").exists())

    def test_the_end_of_the_server_is_the_end_of_its_measurement(self):
        served = self.serve()
        served.ask("POST", "/api/jobs", {"experiment": "experiment/experiment.toml", "output": "cut"})
        while not served.job()["stage"]:
            time.sleep(0.02)
        children = children_of(served.process.pid)
        self.assertTrue(children)
        self.assertEqual(served.end(), 0)
        for child in children:
            self.assertFalse(os.path.exists(f"/proc/{child}"), child)

    def test_a_server_that_is_killed_leaves_no_measurement_behind(self):
        served = self.serve()
        served.ask("POST", "/api/jobs", {"experiment": "experiment/experiment.toml", "output": "cut"})
        while not served.job()["stage"]:
            time.sleep(0.02)
        children = children_of(served.process.pid)
        self.assertTrue(children)
        served.process.kill()
        served.process.communicate(timeout=30)
        for _ in range(300):
            if not any(runs(child) for child in children):
                break
            time.sleep(0.1)
        self.assertFalse([child for child in children if runs(child)])
        self.assertFalse((self.out / "cut/result.nc").exists())

    def test_a_measurement_that_is_killed_takes_nothing_else_down(self):
        served = self.serve()
        served.ask("POST", "/api/jobs", {"experiment": "experiment/experiment.toml", "output": "cut"})
        while not served.job()["stage"]:
            time.sleep(0.02)
        for child in children_of(served.process.pid):
            os.kill(child, signal.SIGSEGV)
        job = served.wait_for_job()
        self.assertEqual((job["state"], job["signal"]), ("failed", signal.SIGSEGV))
        self.assertEqual(served.ask("GET", "/api/state")[0].status, 200)

    def test_progress_comes_as_lines_for_programs(self):
        done = run("measure", self.out / "experiment", "-o", self.folder / "lines", "--progress",
                   "--interactive", "no", check_code=0)
        told = [json.loads(line)["progress"] for line in done.stderr.splitlines()
                if line.startswith('{"progress"')]
        self.assertIn("reducing maps", {one["stage"] for one in told})
        self.assertTrue(all(0.0 <= one["fraction"] <= 1.0 for one in told))


if __name__ == "__main__":
    main()
