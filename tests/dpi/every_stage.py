#!/usr/bin/env python3
"""Every stage of a design through DPI-C, packet by packet: a test bench made from the functions of halfplane_dpi gives each
stage what `halfplane vectors` recorded, and what comes out must be what was recorded. It has no RTL in it.

usage: every_stage.py PROGRAM LIBRARY FOLDER DESIGN...     LIBRARY: libhalfplane_c.so; needs Verilator. FOLDER is made.
"""

import pathlib
import re
import subprocess
import sys

PRIMITIVES = 8
FUNCTION = re.compile(r"function automatic (?:void|bit) (put|get)_(\w+)\(chandle stage, (?:output )?(\w+) packet\)")
MAKER = re.compile(r"function automatic chandle new_(\w+)\(\);")

BENCH = """// Written by tests/dpi/every_stage.py.
module every_stage;
  import raster_pkg::*;
  import halfplane_dpi::*;

  string folder;
  int packets = 0;

  function automatic int opened(string name);
    int file;
    file = $fopen({folder, "/", name, ".hex"}, "r");
    if (file == 0) $fatal(1, "%%s: there is no such file", name);
    return file;
  endfunction
%s
  initial begin
    if (!$value$plusargs("folder=%%s", folder)) $fatal(1, "give +folder=FOLDER");
%s
    $display("%d stages, %%0d packets", packets);
    $finish;
  end
endmodule
"""

STAGE = """
  task automatic run_{stage}();
    chandle stage = new_{stage}();
    int file;
{ports}
    halfplane_stage_free(stage);
  endtask
"""

PUT = """    begin
      {type} packet;
      file = opened("{stage}/{port}");
      while ($fscanf(file, "%h\\n", packet) == 1) begin
        put_{stage}_{port}(stage, packet);
        packets++;
      end
      $fclose(file);
    end"""

GET = """    begin
      {type} packet, got;
      int number = 0;
      file = opened("{stage}/{port}");
      while ($fscanf(file, "%h\\n", packet) == 1) begin
        if (!get_{stage}_{port}(stage, got)) $fatal(1, "{stage}: {port} %0d does not come", number);
        if (got != packet) $fatal(1, "{stage}: {port} %0d is %h, recorded was %h", number, got, packet);
        number++;
      end
      if (get_{stage}_{port}(stage, got)) $fatal(1, "{stage}: {port} %0d was not recorded", number);
      packets += number;
      $fclose(file);
    end"""


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    return done.returncode, done.stdout + done.stderr


def must(*command):
    status, text = run(*command)
    if status != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: status {status}\n{text}")
    return text


def stages_of(package):
    """{stage: [(put or get, port, type)]}, as halfplane_dpi has them."""
    stages = {name: [] for name in MAKER.findall(package) if name not in ("stage", "config")}
    for direction, name, kind in FUNCTION.findall(package):
        stage = max((s for s in stages if name.startswith(s + "_")), key=len)
        stages[stage].append((direction, name.removeprefix(stage + "_"), kind))
    return stages


def bench_text(stages):
    tasks = ""
    for stage, ports in stages.items():
        parts = [(PUT if way == "put" else GET).format(stage=stage, port=port, type=kind) for way, port, kind in ports]
        tasks += STAGE.format(stage=stage, ports="\n".join(parts))
    return BENCH % (tasks, "\n".join(f"    run_{stage}();" for stage in stages), len(stages))


def build(folder, library):
    """Without time, so without coroutines; it runs once, so it is not optimised."""
    must(
        "verilator", "--cc", "--exe", "--main", "--build", "--no-timing", "-Wno-fatal", "-Wno-lint",
        "--top-module", "every_stage", "--Mdir", folder / "obj", "--prefix", "every_stage",
        "-MAKEFLAGS", "OPT_FAST=-O0 OPT_SLOW=-O0 OPT_GLOBAL=-O0",
        folder / "raster_pkg.sv", folder / "halfplane_dpi.sv", folder / "every_stage.sv",
        "-LDFLAGS", f"{library} -Wl,-rpath,{library.parent}", "-o", "every_stage",
    )  # fmt: skip


def damaged_is_found(folder, vectors):
    """A digit of what comes out is another one."""
    file = vectors / "cull" / "triangle.hex"
    text = file.read_text(encoding="ascii")
    file.write_text(text[:-2] + f"{int(text[-2], 16) ^ 1:x}\n", encoding="ascii")
    status, said = run(folder / "obj/every_stage", f"+folder={vectors}")
    return status != 0 and "cull: triangle" in said


def main(program, library, folder, designs):
    for design in designs:
        place = folder / design
        vectors = place / "vectors"
        vectors.mkdir(parents=True, exist_ok=True)
        for option, name in (("--sv", "raster_pkg.sv"), ("--dpi", "halfplane_dpi.sv")):
            (place / name).write_text(must(program, "config", "--config", design, option), encoding="ascii")
        stages = stages_of((place / "halfplane_dpi.sv").read_text(encoding="ascii"))
        for stage in stages:
            must(program, "vectors", "--random", PRIMITIVES, "--config", design, "--stage", stage, "--format", "hex", "-o",
                 vectors / stage, "--quiet")  # fmt: skip
        (place / "every_stage.sv").write_text(bench_text(stages), encoding="ascii")
        build(place, library)
        said = must(place / "obj/every_stage", f"+folder={vectors}")
        found = re.search(r"(\d+) stages, (\d+) packets", said)
        print(f"{design}: {found[0]}")
        if len(stages) < 9 or int(found[2]) < 1000:
            raise SystemExit(f"{design}: few were judged")
        if not damaged_is_found(place, vectors):
            raise SystemExit(f"{design}: a packet with another bit is not found")


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]).absolute(), pathlib.Path(sys.argv[3]), sys.argv[4:])
