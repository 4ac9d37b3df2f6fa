#!/usr/bin/env python3
"""view_test.py REEB: `reeb view` serves its page and its files, and nothing else, to this machine alone."""
import http.client
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import urllib.parse

REEB = sys.argv[1]


def expect(given, wanted, what):
    if given != wanted:
        raise SystemExit(f"{what}: {given!r}, not {wanted!r}")


class Viewer:
    """The command while it runs."""

    def __init__(self, *words):
        self.process = subprocess.Popen([REEB, "view", "--no-open", *words], stderr=subprocess.PIPE, text=True)
        address = re.search(r"http://127\.0\.0\.1:(\d+)/\?(\S+)", self.process.stderr.readline())
        self.port = int(address.group(1))
        self.query = dict(urllib.parse.parse_qsl(address.group(2)))

    def ask(self, path, method="GET", **headers):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        connection.request(method, path, headers=headers)
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer.status, answer.getheader("Content-Type"), body

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)
        self.process.stderr.read()
        return self.process.wait(20)


def check_answers(viewer, home):
    expect(viewer.ask("/"), (200, "text/html", b"<p>player</p>"), "the page")
    expect(viewer.ask("/assets/a.wasm?x=1"), (200, "application/wasm", b"\0asm"), "a part of it")
    for key, name in (("file", "a walk.reeb"), ("with", "other.reeb")):
        path = "/" + viewer.query[key]
        expect(urllib.parse.unquote(path.split("/")[-1]), name, "the name of a file")
        expect(viewer.ask(path), (200, "model/vnd.reeb", (home / name).read_bytes()), name)
    status, _, body = viewer.ask("/", "HEAD")
    expect((status, body), (200, b""), "HEAD")
    expect(viewer.ask("/", "POST")[0], 405, "POST")
    for path in ("/none", "/../secret", "/assets", "/files/2/other.reeb", "//etc/passwd"):
        expect(viewer.ask(path)[0], 404, path)
    expect(viewer.ask("/", Host="elsewhere.example")[0], 403, "another host")


def check_odd_requests(viewer):
    for bytes_ in (b"", b"\r\n\r\n", b"GET\r\n\r\n", b"GET /\r\nHost:" + b" " * 40000, b"\0" * 100 + b"\r\n\r\n"):
        with socket.create_connection(("127.0.0.1", viewer.port), 20) as connection:
            try:
                connection.sendall(bytes_)
                connection.shutdown(socket.SHUT_WR)
                while connection.recv(4096):
                    pass
            except OSError:  # the other side has had enough
                pass
    expect(viewer.ask("/")[0], 200, "after odd requests")


def check_faults(home):
    page = home / "page"
    for words, code, message in (([home / "none.reeb", "--page", page], 1, "none.reeb"),
                                 ([home / "other.reeb", "--page", home], 1, "no player here"),
                                 ([home / "other.reeb", "--page", page, "--port", "70000"], 2, "port")):
        done = subprocess.run([REEB, "view", "--no-open", *map(str, words)], capture_output=True, text=True, timeout=20)
        expect(done.returncode, code, f"exit code of {words}")
        expect(message in done.stderr, True, f"'{message}' in {done.stderr!r}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        home = pathlib.Path(folder)
        (home / "page" / "assets").mkdir(parents=True)
        (home / "page" / "index.html").write_bytes(b"<p>player</p>")
        (home / "page" / "assets" / "a.wasm").write_bytes(b"\0asm")
        (home / "secret").write_text("not for the page")
        (home / "a walk.reeb").write_bytes(bytes(range(256)) * 3000)
        (home / "other.reeb").write_bytes(b"other")
        viewer = Viewer(str(home / "a walk.reeb"), str(home / "other.reeb"), "--page", str(home / "page"))
        try:
            check_answers(viewer, home)
            check_odd_requests(viewer)
            expect(viewer.interrupt(), 130, "exit code after Ctrl-C")
        finally:
            viewer.process.kill()
        check_faults(home)


main()
