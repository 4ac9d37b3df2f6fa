"""D: the commands, as somebody new to them tries them."""
import fcntl
import json
import os
import pty
import re
import struct
import subprocess
import termios

from demands import cache

COMMANDS = ["encode", "decode", "info", "verify", "compare", "sample", "picture", "plot", "segment", "index", "search"]


def sample(w, frames=40):
    """s.pc2 with s.obj, and s.reeb in groups of two frames."""
    w.run("sample", "mechanism", "--length", str(frames), "-o", "s.pc2")
    w.run("encode", "s.pc2", "-o", "s.reeb", "--effort", "1", "--group-length", "2")
    return w.read("s.reeb")


def on_terminal(w, command, columns):
    """Exit code, and what a terminal of so many columns shows of standard output and error."""
    here, there = pty.openpty()
    fcntl.ioctl(there, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
    child = subprocess.Popen([w.reeb, *command], cwd=w.folder, stdin=subprocess.DEVNULL, stdout=there, stderr=there)
    os.close(there)
    seen = b""
    while True:
        try:
            piece = os.read(here, 65536)
        except OSError:
            break
        if not piece:
            break
        seen += piece
    os.close(here)
    return child.wait(), re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", seen.decode("utf-8", "replace"))


def damaged(w):
    w.demand("D1: a truncated file gives what is before the cut, and exit code 1 or --keep-going")
    data = sample(w)
    w.write("t.reeb", data[:len(data) * 2 // 3])
    for command in (["decode", "t.reeb", "-o", "t.pc2"], ["encode", "t.reeb", "-o", "u.reeb"], ["info", "t.reeb"],
                    ["compare", "s.pc2", "t.reeb"]):
        writes = "-o" in command
        w.expect_run(command, 1, "frames 2[0-9] to 40 of 40 are damaged or cut off")
        if writes:
            w.expect(True, os.path.exists(w.path(command[-1])))
        w.expect_run([*command, "--keep-going", *(["-f"] if writes else [])], 0, "cut off")
    w.demand("D1: one damaged group of 20 does not cost the other 19")
    sample(w)
    middle = len(data) // 2
    w.write("d.reeb", data[:middle] + bytes([data[middle] ^ 0xff]) + data[middle + 1:])
    w.expect_run(["decode", "d.reeb", "-o", "d/f_%d.obj"], 1, "of 40 are damaged")
    w.expect(38, len(os.listdir(w.path("d"))))
    w.expect_run(["decode", "d.reeb", "-o", "d/f_%d.obj", "--keep-going", "-f"], 0)
    for cut in (8, 40, 100, len(data) // 10, len(data) - 20, len(data) - 1):
        w.demand(f"D1: a file cut to {cut} of {len(data)} bytes")
        sample(w)
        w.write("t.reeb", data[:cut])
        for command in (["decode", "t.reeb", "-o", "t.pc2"], ["info", "t.reeb"], ["verify", "t.reeb"],
                        ["compare", "s.pc2", "t.reeb"]):
            done = w.expect_run(command, 1, "t.reeb")
            w.expect("no 'frames 1 to 0'", done.err, "1 to 0" not in done.err)
    w.demand("D1: verify checks several files and writes nothing")
    sample(w)
    w.write("d.reeb", data[:middle] + bytes([data[middle] ^ 0xff]) + data[middle + 1:])
    before = sorted(os.listdir(w.folder))
    w.expect_run(["verify", "s.reeb", "s.reeb"], 0, "good")
    w.expect_run(["verify", "s.reeb", "d.reeb"], 1, "d.reeb")
    w.expect_run(["verify", "none.reeb"], 1, "none.reeb")
    w.expect(before, sorted(os.listdir(w.folder)))


def output(w):
    w.demand("D2: what standard output does not take is an error everywhere")
    sample(w, 4)
    for command in ("info s.reeb", "info --json s.reeb", "info --trace s.reeb", "compare s.pc2 s.reeb",
                    "compare --json s.pc2 s.reeb", "encode s.pc2 -o o.reeb -f --json", "decode s.reeb -o -",
                    "encode s.pc2 -o -", "--help", "help encode", "--version"):
        done = w.shell(f"reeb {command} > /dev/full")
        w.expect((command, 1), (done.code, done.err), done.code == 1 and done.says("cannot be written"))
    for command in ("info s.reeb", "decode s.reeb -o -", "compare --json s.pc2 s.reeb"):
        done = w.shell(f"( sleep 0.2; reeb {command}; echo code $? >&2 ) | true; wait")
        w.expect((command, 1), done.err, done.says("Broken pipe", "code 1"))
    w.demand("D2: decode writes a point cache or one mesh to standard output, by any of its names")
    sample(w, 4)
    w.run("decode", "s.reeb", "-o", "a.pc2")
    for name in ("-", "/dev/stdout"):
        done = w.shell(f"reeb decode s.reeb -o {name} --format pc2 | cat")
        w.expect((name, "the cache"), (len(done.out), done.err), done.out == w.read("a.pc2"))
    for kind in ("obj", "ply", "off", "stl"):
        done = w.run("decode", "s.reeb", "-o", "-", "--format", kind, "--frames", "2")
        w.run("decode", "s.reeb", "-o", "b." + kind, "--frames", "2")
        w.expect((kind, "one mesh"), (len(done.out), done.err), done.out == w.read("b." + kind))
        w.expect_run(["decode", "s.reeb", "-o", "-", "--format", kind], 2)
    done = w.shell("reeb encode s.pc2 -o - | reeb decode - -o - --format pc2 | wc -c")
    w.expect(len(w.read("a.pc2")), int(done.out))
    w.expect("no folder -", os.listdir(w.folder), "-" not in os.listdir(w.folder))
    w.demand("D2: binary data do not go to a terminal without -f")
    sample(w, 4)
    for command, code in ((["decode", "s.reeb", "-o", "-"], 1), (["encode", "s.pc2", "-o", "-"], 1),
                          (["decode", "s.reeb", "-o", "-", "-f"], 0),
                          (["decode", "s.reeb", "-o", "-", "--format", "obj", "--frames", "1"], 0)):
        seen, text = on_terminal(w, command, 80)
        w.expect((*command, code), (seen, text[:80]), seen == code)


def doors(w):
    w.demand("D3: the output is tried before the work")
    w.run("sample", "mechanism", "--length", "3", "-o", "s.pc2")
    w.write("there.reeb", "mine")
    w.write("file", "")
    for name, word in [("there.reeb", "pass -f"), ("file/x.reeb", "file"), ("/proc/x.reeb", "/proc"),
                       ("x" * 300 + ".reeb", "shorter name"), (".", "end in .reeb")]:
        done = w.run("encode", "s.pc2", "-o", name)
        w.expect((name[:20], "1 or 2", word), (done.code, done.err), done.code in (1, 2) and done.says(word))
    w.expect(b"mine", w.read("there.reeb"))
    w.demand("D3: overwriting keeps the permissions of a file")
    w.run("sample", "mechanism", "--length", "3", "-o", "s.pc2")
    w.write("s.reeb", "")
    os.chmod(w.path("s.reeb"), 0o640)
    w.expect_run(["encode", "s.pc2", "-o", "s.reeb", "-f"], 0)
    w.expect("0o640", oct(os.stat(w.path("s.reeb")).st_mode & 0o777))
    for name, code in (("TERM", 143), ("INT", 130), ("HUP", 129)):
        w.demand(f"D3: SIG{name} ends the work with {code} and leaves nothing; ignored, it stays ignored")
        w.run("sample", "creature", "--length", "60", "-o", "c.pc2")
        done = w.shell(f"timeout -s {name} --preserve-status 1 reeb encode c.pc2 -o x.reeb --effort 9; echo $?; ls")
        lines = done.out.decode().split()
        w.expect((code, "no x.reeb"), lines, lines[0] == str(code) and "x.reeb" not in lines)
        done = w.shell(f"trap '' {name}; reeb encode c.pc2 -o y.reeb --effort 1 -q & sleep 0.5; kill -{name} $!; "
                       "wait $!; echo $?; ls y.reeb")
        w.expect([b"0", b"y.reeb"], done.out.split())


def usage(w):
    w.demand("D5: a misspelt command is named with the nearest one")
    for typed, meant in [("encdoe", "encode"), ("decod", "decode"), ("ifno", "info"), ("verfy", "verify"),
                         ("pictrue", "picture")]:
        w.expect_run([typed, "x"], 2, f"'{typed}'", f"'{meant}'")
    w.expect_run(["triangulate", "x"], 2, "'triangulate'", "reeb --help")
    w.demand("D5: reeb help COMMAND is reeb COMMAND --help")
    for command in COMMANDS:
        w.expect((0, True), (w.expect_run(["help", command], 0).code,
                             w.run("help", command).out == w.run(command, "--help").out))
    w.expect_run(["help", "nonsense"], 2)
    w.demand("D5: every usage error begins with reeb: and is exit code 2")
    encode = ["encode", "x", "-o", "y.reeb"]
    for command in [[], ["--nonsense"], ["encode"], ["encode", "x"], ["encode", "x", "-o"], [*encode, "--nonsense"],
                    [*encode, "--kg", "abc"], [*encode, "--kg", "-1"], [*encode, "--kg", "1", "--lossless"],
                    [*encode, "--size", "2X"], [*encode, "--size", "0"], [*encode, "--effort", "10"],
                    [*encode, "--profile", "best"], [*encode, "--max-error", "1 %%"], ["decode"], ["decode", "x", "y"],
                    ["decode", "x", "-o", "y.obj", "--frames", "a"], ["decode", "x", "-o", "y", "-T", "-1"], ["info"],
                    ["compare", "a"], ["plot"], ["segment"], ["search"], ["index"], ["sample"], ["verify"],
                    ["picture"], ["sample", "zebra", "-o", "a.obj"]]:
        done = w.expect_run(command, 2, r"\Areeb: ")
        w.expect(b"", done.out)
    w.demand("D5: help wraps at the terminal's width")
    for columns in (50, 80, 200):
        for command in COMMANDS:
            _, text = on_terminal(w, ["help", command], columns)
            longest = max(len(line) for line in text.splitlines())
            w.expect((command, f"at most {columns}"), longest, longest <= columns)


def figures(w):
    w.demand("D5: numbers are plain")
    w.write("still.obj", "".join(f"v {i % 50} {i // 50} 0\n" for i in range(2500)) + "f 1 2 51\n")
    w.write("still.pc2", cache(2500, [[c for i in range(2500) for c in (i % 50, i // 50, 0)]] * 300))
    done = w.expect_run(["encode", "still.pc2", "-o", "still.reeb"], 0, r"[0-9],[0-9]{3} times smaller")
    w.expect("no exponent", done.err, "e+" not in done.err)
    w.demand("D5: --size takes suffixes")
    w.run("sample", "sheet", "--length", "3", "-o", "p.pc2")
    for typed in ("2G", "1M", "100k", "1GiB", "5MiB", "64KiB", "1.5M", "20000", "20kB"):
        w.expect_run(["encode", "p.pc2", "-o", "p.reeb", "-f", "--size", typed], 0)


def names(w):
    w.demand("D5: compare and picture take a mesh for a point cache, as the message says")
    w.run("sample", "sheet", "--length", "5", "-o", "p.pc2")
    w.shell("mv p.obj mesh.obj; mv p.pc2 cache.pc2")
    w.expect_run(["encode", "mesh.obj", "cache.pc2", "-o", "p.reeb"], 0)
    w.expect_run(["compare", "mesh.obj", "cache.pc2", "p.reeb"], 0)
    w.expect_run(["compare", "p.reeb", "mesh.obj", "cache.pc2"], 0)
    w.expect_run(["picture", "mesh.obj", "cache.pc2", "-o", "p.png"], 0)
    w.expect_run(["picture", "mesh.obj", "cache.pc2", "p.reeb", "-o", "q.png"], 0)
    w.expect_run(["compare", "cache.pc2", "p.reeb"], 1, "mesh before the cache")
    w.demand("D5: extensions that mean another format are refused")
    w.write("t.csv", "codec,bpvf,kg\na,1,2\na,2,1\n")
    w.run("sample", "sheet", "--length", "3", "-o", "p.pc2")
    w.run("encode", "p.pc2", "-o", "p.reeb")
    for name in ("walk.glb", "walk.obj", "walk.abc", "walk.OBJ", "p.zip"):
        w.expect_run(["encode", "p.pc2", "-o", name], 2)
    for name in ("walk.glb", "walk.reeb", "w_%d.fbx", "p.gltf", "p.usd"):
        w.expect_run(["decode", "p.reeb", "-o", name], 2)
    w.expect_run(["picture", "p.reeb", "-o", "p.jpg"], 2)
    w.expect_run(["picture", "p.reeb", "-o", "p.reeb"], 2)
    w.expect_run(["plot", "t.csv", "-o", "p.png"], 2)
    w.expect_run(["segment", "p.pc2", "-o", "p.jpg"], 2)
    w.expect_run(["segment", "p.pc2", "-o", "x.ply", "--png", "x.jpg"], 2)
    w.expect_run(["sample", "sheet", "-o", "p.glb"], 2)
    w.demand("D5: --json with names that are not UTF-8")
    sample(w, 3)
    w.shell("cp s.pc2 $'s\\xe4.pc2'; cp s.obj $'s\\xe4.obj'")
    for command in (["encode", b"s\xe4.pc2", "-o", b"o\xff.reeb", "--json"],
                    ["compare", b"s\xe4.pc2", b"o\xff.reeb", "--json"], ["info", b"o\xff.reeb", "--json"]):
        done = w.expect_run(command, 0)
        w.expect("JSON", done.out[:60], bool(json.loads(done.out.decode("utf-8"))))


def frames(w):
    w.demand("D5: one meaning of --frames")
    sample(w, 10)
    w.expect_run(["encode", "s.pc2", "-o", "b.reeb", "--frames", "9:2,1"], 0)
    w.expect(9, json.loads(w.run("info", "b.reeb", "--json").out)["frames"])
    for text, code in [("1", 0), ("2:4", 0), (":3", 0), ("8:", 0), ("4:2", 0), ("1,3,5:7", 0), ("0", 2), ("a", 2),
                       ("1:2:3", 2), ("", 2), ("1,,2", 2), ("-1", 2), ("1;2", 2), ("11", None), ("5:20", None)]:
        seen = [w.run(*command, "--frames=" + text).code
                for command in (["encode", "s.pc2", "-o", "x.reeb", "-f"], ["decode", "s.reeb", "-o", "x.pc2", "-f"],
                                ["compare", "s.pc2", "s.reeb"], ["picture", "s.reeb", "-o", "x.png", "-f"])]
        w.expect((text, code), seen, len(set(seen)) == 1 and (seen[0] == code or (code is None and seen[0] > 0)))
    w.demand("D5: an MDD or PC2 without rate invents none")
    w.write("a.obj", "v 0 0 0\n")
    w.write("a.mdd", struct.pack(">II", 3, 1) + struct.pack(">3f", 0, 0, 0) + struct.pack(">9f", *range(9)))
    w.write("b.obj", "v 0 0 0\n")
    w.write("b.pc2", cache(1, [[0, 0, 0], [1, 0, 0]]))
    for name in ("a.mdd", "b.pc2"):
        w.run("encode", name, "-o", "r.reeb", "-f", "--lossless")
        report = json.loads(w.run("info", "r.reeb", "--json").out)
        w.expect((name, "no rate"), report, not report.get("fps") and not report.get("frame_rate"))
    w.expect_run(["decode", "r.reeb", "-o", "x.mdd"], 1, "--fps")


def information(w):
    w.demand("D6: info tells profile, target, measured error and box, of several files")
    sample(w, 10)
    w.run("encode", "s.pc2", "-o", "k.reeb", "--kg", "0.2", "--profile", "fast")
    text = w.run("info", "k.reeb", "s.reeb").out.decode()
    for word in ("k.reeb", "s.reeb", "fast", "0.2 %", "RMSE", "maximum", "within (", "frames"):
        w.expect(word, text, word in text)
    w.expect(2, len(json.loads(w.run("info", "k.reeb", "s.reeb", "--json").out)))
    done = w.expect_run(["info", "k.reeb", "none.reeb", "s.reeb"], 1, "none.reeb")
    w.expect("both others", done.out, b"k.reeb" in done.out and b"s.reeb" in done.out)
    w.demand("D6: the bar fits narrow terminals and tells the time to go, also while point caches are read")
    w.run("sample", "creature", "--length", "40", "-o", "c.pc2")
    for columns in (20, 40, 80):
        for command in (["encode", "c.pc2", "-o", "c.reeb", "-f", "--effort", "1"],
                        ["decode", "c.reeb", "-o", "d.pc2", "-f"], ["compare", "c.pc2", "c.reeb"]):
            _, text = on_terminal(w, command, columns)
            bars = [b for b in text.split("\r") if re.match(r"(read|encod|decod)ing .*%", b)]
            longest = max(len(bar) for bar in bars) if bars else 0
            w.expect((*command, f"1 to {columns} wide"), longest, 0 < longest <= columns)
    _, text = on_terminal(w, ["encode", "c.pc2", "-o", "c.reeb", "-f", "--effort", "9"], 80)
    w.expect("reading, and time left", text[:400], "reading" in text and " left" in text)
    w.demand("D6: a plot with defaults tells codecs apart, its legend inside the page")
    rows = [f"a,codec {c} {'with a long name ' * 4},{1 + i + c},{2 / (i + 1)}\n" for c in range(4) for i in range(4)]
    w.write("t.csv", "sequence,codec,bpvf,kg\n" + "".join(rows))
    w.expect_run(["plot", "t.csv", "-o", "t.svg"], 0)
    svg = w.read("t.svg").decode()
    width = float(re.search(r'<svg[^>]* width="([0-9.]+)', svg).group(1))
    ends = [float(x) + 4 * len(text) for x, text in re.findall(r'<text[^>]* x="([0-9.]+)"[^>]*>(a codec [^<]*)<', svg)]
    w.expect(f"four names, left of {width}", ends, len(ends) == 4 and max(ends) <= width)


STEPS = [damaged, output, doors, usage, figures, names, frames, information]
