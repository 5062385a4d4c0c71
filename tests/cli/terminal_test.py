"""What a person at a terminal sees: one table, colours, progress.

Usage: terminal_test.py PROGRAM [unittest arguments]
"""

import codecs
import fcntl
import os
import pty
import re
import signal
import struct
import subprocess
import termios
import time

from support import DemoFolder, PROGRAM, main, run

COLOURS = {"agrees": 32, "only the drop": 33, "differs": 31}
BAR = re.compile(r"^(.+?) +\[([#.]+)\] +(\d+) %")


def shown(text):
    """The lines that stand on a wide screen: what returns and wipes have left of each."""
    lines = []
    for line in re.sub(r"\033\[\d+m", "", text).replace("\r\n", "\n").split("\n"):
        left, column = "", 0
        for part in re.split(r"(\r|\033\[K)", line):
            if part == "\r":
                column = 0
            elif part == "\033[K":
                left = left[:column]
            else:
                left = left[:column] + part + left[column + len(part):]
                column += len(part)
        lines.append(left.rstrip())
    return lines


class Terminal:
    """The program on a terminal of its own."""

    def __init__(self, *arguments, columns=80, one_stream=None, **environment):
        self.master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))
        known = {key: value for key, value in os.environ.items()
                 if key not in ("COLUMNS", "NO_COLOR")}
        streams = {"stdout": slave, "stderr": slave}
        if one_stream:
            streams = {name: slave if name == one_stream else subprocess.PIPE for name in streams}
        self.process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdin=subprocess.DEVNULL,
                                        env={**known, "TERM": "xterm", **environment}, **streams)
        os.close(slave)
        self.text, self.decoder = "", codecs.getincrementaldecoder("utf-8")()

    def read_until(self, pattern):
        """Reads until a pattern has come; None: all there is."""
        while pattern is None or not re.search(pattern, self.text):
            try:
                some = os.read(self.master, 65536)
            except OSError:  # so Linux tells that the program has closed its end
                some = b""
            if not some:
                break
            self.text += self.decoder.decode(some)
        return self.text

    def end(self):
        self.read_until(None)
        os.close(self.master)
        return self.process.wait(timeout=60), self.text


class TerminalTest(DemoFolder):
    def on_terminal(self, *options, code=0, **wishes):
        terminal = Terminal("measure", self.out / "experiment", "-o", self.folder / "out",
                            "--nonlocal", "false", *options, **wishes)
        status, text = terminal.end()
        self.assertEqual(status, code, text)
        return text

    def test_verdicts_are_coloured_on_a_terminal_alone(self):
        text = self.on_terminal()
        verdicts = [line for line in text.splitlines() if re.match(r"Q\d+ ", line)]
        self.assertGreater(len(verdicts), 0)
        for line in verdicts:
            word = next(word for word in COLOURS if word in line)
            self.assertIn(f"\033[{COLOURS[word]}m{word}\033[0m", line)
        plain = self.on_terminal(NO_COLOR="1")
        self.assertNotRegex(plain, r"\033\[\d+m")
        for line in verdicts:
            self.assertIn(re.sub(r"\033\[\d+m", "", line), shown(plain))
        pipe = self.in_a_pipe()
        for written in (self.on_terminal(TERM="dumb"), pipe.stdout, pipe.stderr):
            self.assertNotIn("\033", written)
            self.assertNotIn("[#", written)

    def in_a_pipe(self, *options):
        return run("measure", self.out / "experiment", "-o", self.folder / "out", "--nonlocal", "false",
                   *options, check_code=0)

    def test_no_line_is_broken_by_the_terminal(self):
        for columns in (80, 60):
            for text in (self.on_terminal("--details", columns=columns),
                         self.on_terminal(COLUMNS=str(columns), columns=200)):
                # A path has no blank to break it at.
                self.assertEqual([line for line in shown(text)
                                  if len(line) > columns and " " in line.strip()], [])
        frames = re.split(r"[\r\n]", self.on_terminal(columns=60))
        bars = [frame for frame in frames if "[#" in frame]
        self.assertGreater(len(bars), 0)
        self.assertTrue(all(len(frame.replace("\033[K", "")) < 60 for frame in bars), bars)

    def test_progress_never_runs_back_and_leaves_nothing_behind(self):
        text = self.on_terminal()
        shares = {}
        for frame in re.split(r"[\r\n]", text):
            if match := BAR.match(frame):
                stage, bar, share = match[1], match[2], int(match[3])
                self.assertGreaterEqual(share, shares.get(stage, 0))
                self.assertLessEqual(abs(bar.count("#") / len(bar) - 0.01 * share), 1 / len(bar))
                shares[stage] = share
        self.assertEqual(shares["reducing maps"], 100)
        self.assertEqual(shares["reading p(x)"], 100)
        self.assertFalse([line for line in shown(text) if "[#" in line])
        # The table begins a line of its own.
        self.assertTrue([line for line in shown(text) if line.startswith("run ")])

    def test_progress_goes_to_standard_error_alone(self):
        terminal = Terminal("measure", self.out / "experiment", "-o", self.folder / "out", "--nonlocal",
                            "false", one_stream="stderr")
        text = terminal.read_until(None)
        stdout = terminal.process.stdout.read().decode()
        self.assertEqual(terminal.end()[0], 0)
        terminal.process.stdout.close()
        self.assertIn("[#", text)
        self.assertEqual(stdout, self.in_a_pipe().stdout)
        self.assertNotIn("[#", self.on_terminal("--quiet"))

    def test_a_fault_takes_the_bar_away(self):
        broken = self.renamed("broken")
        last = sorted(broken.glob("*.gsf"))[-1]
        last.write_bytes(last.read_bytes()[:-1000])
        status, text = Terminal("measure", broken, "-o", self.folder / "broken_out", "--threads",
                                "1").end()
        self.assertEqual(status, 2, text)
        self.assertIn("\033[K", text)
        lines = shown(text)
        self.assertFalse([line for line in lines if "[#" in line or "finding" in line], lines)
        self.assertTrue([line for line in lines if line.startswith("manoscope: error: ")], lines)

    def test_ctrl_c_takes_the_bar_away_once_or_twice(self):
        for times in (1, 2):
            terminal = Terminal("measure", self.out / "experiment", "-o", self.folder / "stopped",
                                "--threads", "1")
            terminal.read_until(r"\[#")
            for _ in range(times):
                terminal.process.send_signal(signal.SIGINT)
                time.sleep(0.005)
            status, text = terminal.end()
            lines = shown(text)
            self.assertFalse([line for line in lines if "[#" in line or "%" in line], lines)
            if times == 1:
                self.assertEqual(status, 130)
                self.assertIn("manoscope: stopped: interrupted; nothing was half-written", lines)
            else:
                self.assertIn(status, (130, -signal.SIGINT))
            self.assertFalse((self.folder / "stopped").exists())


if __name__ == "__main__":
    main()
