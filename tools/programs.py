#!/usr/bin/env python3
"""Real OpenGL programs in Mesa's llvmpipe and in Halfplane's driver, the same frame of the same recording.

  programs.py record -o FOLDER [NAME...]    records programs under Xvfb: FOLDER/NAME.trace
  programs.py compare -o FOLDER [NAME...]   draws a frame of each recording twice and compares: table.md, sheet.png
  programs.py window -o FOLDER [NAME...]    replays each recording on both in a window and compares every frame, names the
                                            differences of the worst one by `halfplane compare`: window.md, window.png
  programs.py speed -o FOLDER [NAME...]     replays each recording on both in turn, --runs times: speed.md
  programs.py page -o FOLDER [NAME...]      `compare` and `speed` in one table of all programs: page.md, sheet.png
  programs.py list                          the programs, and whether they are installed

`record --first N` keeps the first N frames of a recording, so that `window` and `speed` have as many of each program.
Needs Debian's apitrace, xvfb, libgl1-mesa-dri and python3-pil, build/halfplane and the driver beside it. Pictures stay in
FOLDER as NAME.mesa.png and NAME.halfplane.png. Exit status 1: a program failed, or one of `compare` or `window` lies over
--most.
"""
import argparse
import concurrent.futures
import glob
import io
import json
import os
import pathlib
import re
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

try:
    from PIL import Image, ImageChops, ImageStat
except ImportError:  # piglit.py needs none
    Image = None

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Name: the command and its package. Screen savers are added by look_for_savers().
PROGRAMS = {
    'glxgears': ('glxgears', 'mesa-utils'),
    'gltron': ('/usr/games/gltron', 'gltron'),
    'chromium-bsu': ('/usr/games/chromium-bsu -w -na', 'chromium-bsu'),
    'billard-gl': ('/usr/games/billard-gl', 'billard-gl'),
    'rrootage': ('/usr/games/rrootage -window', 'rrootage'),
    'torus-trooper': ('/usr/games/torus-trooper -window', 'torus-trooper'),
    'gunroar': ('/usr/games/gunroar -window', 'gunroar'),
    'briquolo': ('/usr/games/briquolo', 'briquolo'),
    'armagetronad': ('/usr/games/armagetronad -window', 'armagetronad'),
    'bzflag': ('/usr/games/bzflag -window 640x480 -solo 3', 'bzflag-client'),
    'tumiki-fighters': ('/usr/games/tumiki-fighters -window', 'tumiki-fighters'),
}
SAVERS = '/usr/libexec/xscreensaver'  # xscreensaver-gl, xscreensaver-gl-extra, rss-glx
SEEN = 8  # of 255: a difference in a channel that counts


def libraries(path):
    done = subprocess.run(['ldd', path], capture_output=True, text=True, check=False)
    return done.stdout


def look_for_savers():
    for path in sorted(glob.glob(f'{SAVERS}/*')):
        if 'libGL' in libraries(path) or 'libEGL' in libraries(path):
            PROGRAMS.setdefault(os.path.basename(path), (f'{path} -window -geometry 300x220', 'xscreensaver-gl'))


def api_of(command):
    return 'egl' if 'libEGL.so' in libraries(shutil.which(command.split()[0]) or '') else 'gl'


def replayer(name):
    return 'eglretrace' if api_of(PROGRAMS[name][0]) == 'egl' else 'glretrace'


class Display:
    """An X server of our own, on the first free number."""

    def __enter__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ['Xvfb', '-displayfd', str(write), '-screen', '0', '800x600x24', '+extension', 'GLX', '-nolisten', 'tcp',
             '-noreset'],
            pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as pipe:
            self.name = ':' + pipe.readline().strip()
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


def environment(display, folder):
    home = folder / 'home'
    home.mkdir(exist_ok=True)
    return os.environ | {'DISPLAY': display, 'HOME': str(home), 'SDL_AUDIODRIVER': 'dummy', 'LIBGL_ALWAYS_SOFTWARE': '1',
                         'XDG_RUNTIME_DIR': str(home)}


def stop(process, patience=4):
    """Ends the whole group: apitrace starts the program as its child."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(process.pid, number)
        except ProcessLookupError:
            return
        try:
            process.wait(patience)
            return
        except subprocess.TimeoutExpired:
            pass


def record(name, folder, display, options):
    command = PROGRAMS[name][0].split()
    trace = folder / f'{name}.trace'
    trace.unlink(missing_ok=True)
    with open(folder / f'{name}.log', 'wb') as log:
        process = subprocess.Popen(
            ['apitrace', 'trace', '--api', api_of(PROGRAMS[name][0]), '-o', str(trace), *command], stdout=log,
            stderr=log, stdin=subprocess.DEVNULL, start_new_session=True, cwd=folder / 'home',
            env=environment(display, folder))
        try:
            process.wait(options.seconds)
        except subprocess.TimeoutExpired:
            pass
        stop(process)
    if not trace.exists():
        return f'{name:20} no recording'
    if options.first:
        whole = trace.rename(folder / f'{name}.whole')
        run(['apitrace', 'trim', f'--frames=0-{options.first - 1}', '-o', str(trace), str(whole)], 240)
        whole.unlink()
    return f'{name:20} {len(swaps(trace)):5} frames {trace.stat().st_size / 1e6:7.1f} MB'


# --- pictures ---------------------------------------------------------------------------------------------------------


def is_blank(picture):
    return all(low == high for low, high in picture.getextrema())


def is_blank_in_both(row):
    return is_blank(row['mesa']) and is_blank(row['ours'])


def gaps_of(a, b):
    """Differences of what both have, from the bottom left, where OpenGL's window begins."""
    width, height = min(a.width, b.width), min(a.height, b.height)
    return ImageChops.difference(*(picture.crop((0, picture.height - height, width, picture.height)) for picture in (a, b)))


def differences(a, b):
    """Share of pixels that differ by more than SEEN in a channel, and mean difference of the channels, of 255."""
    gaps = gaps_of(a, b)
    red, green, blue = gaps.split()
    largest = ImageChops.lighter(ImageChops.lighter(red, green), blue)
    return sum(largest.histogram()[SEEN + 1:]) / (gaps.width * gaps.height), sum(ImageStat.Stat(gaps).mean) / 3


def sheet(groups, columns=4, width=200, height=150, gap=4):
    """Pictures of a program side by side, Mesa's left: in the order of the table, row by row."""
    cell_width, cell_height = gap + (width + gap) * max(map(len, groups)), height + 2 * gap
    whole = Image.new('RGB', (columns * cell_width, -(-len(groups) // columns) * cell_height), '#606060')
    for number, group in enumerate(groups):
        for side, picture in enumerate(group):
            if picture is not None:
                at = (number % columns * cell_width + gap + side * (width + gap), number // columns * cell_height + gap)
                whole.paste(picture.resize((width, height)), at)
    return whole


# --- comparison -------------------------------------------------------------------------------------------------------


def run(words, seconds, **options):
    try:
        return subprocess.run(words, capture_output=True, timeout=seconds, check=False, **options)
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(words, 124, b'', f'took more than {seconds} s'.encode())


def swaps(trace):
    """Numbers of the calls that end frames."""
    dump = run(['apitrace', 'dump', '--color=never', '--calls=frame', str(trace)], 120).stdout.decode(errors='replace')
    return [int(line.split()[0]) for line in dump.splitlines() if re.match(r'\d+ (glX|egl)SwapBuffers', line)]


def in_mesa(name, folder, call, env):
    trace = folder / f'{name}.trace'
    done = run([replayer(name), '--headless', '-s', '-', '-S', str(call), str(trace)], 240, env=env)
    at = done.stdout.find(b'P6')
    if at < 0:
        raise RuntimeError(f'{replayer(name)}: {done.stderr.decode(errors="replace").strip().splitlines()[-1:]}')
    picture = Image.open(io.BytesIO(done.stdout[at:])).convert('RGB')
    picture.save(folder / f'{name}.mesa.png')
    return picture


def configuration(options):
    return ['--config', options.config] + [word for setting in options.set for word in ('--set', setting)]


def in_halfplane(name, folder, frame, options):
    capture, picture = folder / f'{name}.hpt', folder / f'{name}.halfplane.png'
    picture.unlink(missing_ok=True)
    config = configuration(options)
    begun = time.monotonic()
    said = ''
    for words in (['convert', str(folder / f'{name}.trace'), '--frame', str(frame), '-o', str(capture)],
                  ['render', str(capture), '-o', str(picture)]):
        done = run([str(options.halfplane), *words, *config, '--quiet'], 240)
        said += done.stderr.decode(errors='replace')
        if done.returncode != 0 or not pathlib.Path(words[-1]).exists():
            raise RuntimeError(said.strip().splitlines()[-1] if said.strip() else f'exit status {done.returncode}')
    seconds = time.monotonic() - begun
    (folder / f'{name}.said').write_text(said, encoding='utf-8')
    return Image.open(picture).convert('RGB'), seconds, [line.removeprefix('halfplane: ') for line in said.splitlines()]


def compare(name, folder, env, options):
    row = {'name': name, 'mesa': None, 'ours': None, 'error': '', 'said': []}
    try:
        calls = swaps(folder / f'{name}.trace')
        if not calls:
            raise RuntimeError('the recording has no frame')
        row['frame'] = min(options.frame, len(calls) * 3 // 4)
        row['mesa'] = in_mesa(name, folder, calls[row['frame']], env)
        row['ours'], row['seconds'], row['said'] = in_halfplane(name, folder, row['frame'], options)
        row['seen'], row['mean'] = differences(row['mesa'], row['ours'])
        if is_blank_in_both(row):
            row['said'].insert(0, 'both blank: says nothing')
    except (RuntimeError, OSError) as error:
        row['error'] = str(error)
    return row


def table(rows):
    out = ['| program | frame | pixels | differ by more than 8, % | mean of 255 | seconds to the frame | says |',
           '| --- | --- | --- | --- | --- | --- | --- |']
    for row in rows:
        if row['error']:
            out.append(f'| {row["name"]} | {row.get("frame", "")} | | | | | **{row["error"][:100]}** |')
        else:
            ours = row['ours']
            out.append(f'| {row["name"]} | {row["frame"]} | {ours.width}x{ours.height} | {100 * row["seen"]:.2f} | '
                       f'{row["mean"]:.2f} | {row["seconds"]:.1f} | {"; ".join(row["said"])[:120]} |')
    return '\n'.join(out) + '\n'


# --- every frame ------------------------------------------------------------------------------------------------------


def on_driver(env, options, **wishes):
    """The environment of a program that draws on the driver."""
    driver = options.halfplane.resolve().parent / 'gl'
    wishes |= {'preset': options.config, 'config': options.set, 'threads': options.threads}
    return env | {'__GLX_VENDOR_LIBRARY_NAME': 'halfplane', 'LD_LIBRARY_PATH': str(driver),
                  '__EGL_VENDOR_LIBRARY_FILENAMES': str(driver / 'halfplane.json'), 'HALFPLANE_GL': json.dumps(wishes)}


def pictures(name, folder, env):
    """The picture before each swap of a replay."""
    words = [replayer(name), '-s', '-', '-S', '*/frame', str(folder / f'{name}.trace')]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=env) as process:
        try:
            while header := process.stdout.readline():
                if header != b'P6\n':  # what the replayer says
                    continue
                size = process.stdout.readline()
                while size.startswith(b'#'):
                    size = process.stdout.readline()
                width, height = map(int, size.split())
                process.stdout.readline()
                yield Image.frombytes('RGB', (width, height), process.stdout.read(3 * width * height))
        finally:
            process.kill()


def captured_pictures(name, folder, options):
    """The same of the driver by captures: eglretrace asks GLX for the size of a picture where no framebuffer object is."""
    with tempfile.TemporaryDirectory(dir=folder) as place:
        run([str(options.halfplane), 'convert', str(folder / f'{name}.trace'), '-o', place + '/', '--quiet',
             *configuration(options)], 600)
        for capture in sorted(pathlib.Path(place).glob('*.hpt')):
            picture = capture.with_suffix('.png')
            run([str(options.halfplane), 'render', str(capture), '-o', str(picture), '--quiet', *configuration(options)], 60)
            yield Image.open(picture).convert('RGB')


def kinds_of(name, folder, row, options):
    """What `compare` says about the differences of the worst frame, and how many pixels the two ways to it differ in: the
    driver under the replayer, and the capture."""
    capture, found = folder / f'{name}.hpt', {}
    for words in (['convert', str(folder / f'{name}.trace'), '--frame', str(row['frame']), '-o', str(capture), '--quiet'],
                  ['compare', str(capture), '--against', str(folder / f'{name}.mesa.png'), '--tolerance', f'color={SEEN}',
                   '--json', '-o', str(folder / f'{name}.kinds.png'), '--panels', 'against', '--panels', 'difference',
                   '--panels', 'kinds', '--model', str(folder / f'{name}.capture.png')]):
        done = run([str(options.halfplane), *words, *configuration(options)], 240)
    try:
        found = json.loads(done.stdout)['against']['kinds']
    except (json.JSONDecodeError, KeyError, TypeError):
        raise RuntimeError(f'compare: {done.stderr.decode(errors="replace").strip()[-90:]}') from None
    row['kinds'] = {kind: of['pixels'] for kind, of in found.items() if of['pixels']}
    again = Image.open(folder / f'{name}.capture.png').convert('RGB')
    row['capture'] = differences(row['ours'], again)[0]


def compare_all(name, folder, env, options):
    row = {'name': name, 'error': '', 'seen': -1.0}
    shares, means = [], []
    try:
        is_glx = replayer(name) == 'glretrace'
        drawn = pictures(name, folder, on_driver(env, options)) if is_glx else captured_pictures(name, folder, options)
        both = zip(pictures(name, folder, env), drawn)
        for number, (mesa, ours) in enumerate(both):
            if number == 0:  # the replayer gives its window a size in it, and loses what was drawn
                continue
            seen, mean = differences(mesa, ours)
            shares.append(seen)
            means.append(mean)
            row['blank'] = row.get('blank', 0) + (is_blank(mesa) and is_blank(ours))
            if seen > row['seen']:
                row |= {'seen': seen, 'frame': number, 'mesa': mesa, 'ours': ours}
        if not shares:
            raise RuntimeError('no frame')
        row |= {'frames': len(shares), 'equal': shares.count(0), 'median': statistics.median(shares),
                'mean': statistics.mean(means)}
        for side in ('mesa', 'ours'):
            row[side].save(folder / f'{name}.{side.replace("ours", "halfplane")}.png')
        kinds_of(name, folder, row, options)
    except (RuntimeError, OSError, ValueError) as error:
        row['error'] = str(error)
    return row


def window_table(rows):
    out = ['| program | pixels | frames | of these blank in both | without a pixel that differs | differ, %: median | worst '
           '| at frame | mean of 255 | kinds at the worst frame, pixels | its capture, % |', '| --- ' * 11 + '|']
    for row in rows:
        if row['error']:
            out.append(f'| {row["name"]} ' + '| ' * 9 + f'| **{row["error"][:100]}** |')
            continue
        kinds = ', '.join(f'{kind} {pixels}' for kind, pixels in row['kinds'].items()) or '–'
        out.append(f'| {row["name"]} | {row["ours"].width}x{row["ours"].height} | {row["frames"]} | {row["blank"]} | '
                   f'{row["equal"]} | {100 * row["median"]:.2f} | {100 * row["seen"]:.2f} | {row["frame"]} | '
                   f'{row["mean"]:.2f} | {kinds} | {100 * row["capture"]:.2f} |')
    return '\n'.join(out) + '\n'


# --- speed ------------------------------------------------------------------------------------------------------------


def replay(words, env, seconds):
    """Frames, their seconds, and seconds of processors of the whole replay."""
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(words, stdout=said, stderr=said, stdin=subprocess.DEVNULL, env=env)
        watch = threading.Timer(seconds, process.kill)
        watch.start()
        used = os.wait4(process.pid, 0)[2]
        watch.cancel()
        said.seek(0)
        text = said.read().decode(errors='replace')
    done = re.search(r'Rendered (\d+) frames in ([\d.e-]+) secs', text)
    if not done or int(done[1]) == 0:
        raise RuntimeError(f'{words[0]}: {" ".join(text.split())[-120:]}')
    return int(done[1]), float(done[2]), used.ru_utime + used.ru_stime


def speed(name, folder, env, options):
    """Medians of --runs replays on llvmpipe and on the driver in turn. One more says what of a frame is host and raster."""
    row = {'name': name, 'error': ''}
    results = folder / f'{name}.results'
    results.unlink(missing_ok=True)  # of a run that was ended; the driver appends
    mesa = env | {'LP_NUM_THREADS': str(options.threads)}
    ours = on_driver(env, options)
    words = [replayer(name), '-b', str(folder / f'{name}.trace')]
    try:
        _, seconds, _ = replay(words, on_driver(env, options, results=str(results)), 240)
        if not results.exists():
            raise RuntimeError('the driver did not answer')
        rows = [json.loads(line) for line in results.read_text(encoding='utf-8').splitlines()]
        raster = statistics.mean(one['time_s']['geometry'] + one['time_s']['raster'] for one in rows)
        host = seconds / len(rows) - statistics.mean(one['time_s']['waited'] for one in rows)
        pairs = [(replay(words, mesa, 240), replay(words, ours, 240)) for _ in range(options.runs)]
    except (RuntimeError, OSError, json.JSONDecodeError) as error:
        row['error'] = str(error)
        return row
    finally:
        results.unlink(missing_ok=True)
    row |= {'frames': pairs[0][1][0], 'width': rows[-1]['width'], 'height': rows[-1]['height']}
    for key, at in (('', 1), ('used_', 2)):  # seconds a frame
        row |= {f'{key}mesa': statistics.median(m[at] / m[0] for m, _ in pairs),
                f'{key}ours': statistics.median(o[at] / o[0] for _, o in pairs),
                f'{key}ratio': statistics.median(m[at] / m[0] / (o[at] / o[0]) for m, o in pairs)}
    row |= {'raster': raster, 'host': host}
    return row


def speed_table(rows):
    out = ['| program | pixels | frames | llvmpipe, frames/s | Halfplane, frames/s | times as fast | host, ms '
           '| raster, ms | llvmpipe, CPU ms | Halfplane, CPU ms | times less CPU |', '| --- | --- ' + '| --- ' * 9 + '|']
    for row in rows:
        if row['error']:
            out.append(f'| {row["name"]} | | | | | | | | | | **{row["error"][:100]}** |')
            continue
        ms = {key: f'{1e3 * row[key]:.2f}' for key in ('host', 'raster', 'used_mesa', 'used_ours')}
        out.append(f'| {row["name"]} | {row["width"]}x{row["height"]} | {row["frames"]} | {1 / row["mesa"]:.1f} | '
                   f'{1 / row["ours"]:.1f} | {row["ratio"]:.2f} | {ms["host"]} | {ms["raster"]} | {ms["used_mesa"]} | '
                   f'{ms["used_ours"]} | {row["used_ratio"]:.2f} |')
    good = [row for row in rows if not row['error']]
    if len(good) > 1:
        out.append(f'| **median** | | | | | **{statistics.median(row["ratio"] for row in good):.2f}** | | | | | '
                   f'**{statistics.median(row["used_ratio"] for row in good):.2f}** |')
    return '\n'.join(out) + '\n'


def page_table(rows):
    out = ['| program | pixels | frame | differ by more than 8, % | mean of 255 | frames replayed | llvmpipe, CPU ms | '
           'Halfplane, CPU ms | llvmpipe / Halfplane |', '| --- ' * 9 + '|']
    for row in sorted(rows, key=lambda row: bool(row['error'])):  # programs without a frame come last
        if row['error']:
            out.append(f'| {row["name"]} ' + '| ' * 7 + f'| {row["error"][:100]} |')
            continue
        blank = ' (blank)' if is_blank_in_both(row) else ''
        out.append(f'| {row["name"]} | {row["ours"].width}x{row["ours"].height} | {row["frame"]}{blank} | '
                   f'{100 * row["seen"]:.2f} | {row["mean"]:.2f} | {row["frames"]} | {1e3 * row["used_mesa"]:.2f} | '
                   f'{1e3 * row["used_ours"]:.2f} | {row["used_ratio"]:.2f} |')
    return '\n'.join(out) + '\n'


def on_page(name, folder, env, options):
    row = compare(name, folder, env, options)
    if not row['error']:
        pictures = {key: row[key] for key in ('mesa', 'ours', 'frame', 'seen', 'mean')}  # speed has other `mesa` and `ours`
        row = speed(name, folder, env, options) | pictures
    return row


def measure_speed(names, folder, env, options):
    rows = []
    for name in names:
        rows.append(speed(name, folder, env, options))
        print(speed_table(rows[-1:]).splitlines()[2], flush=True)
    (folder / 'speed.md').write_text(speed_table(rows), encoding='utf-8')
    print(speed_table(rows).splitlines()[-1])
    return int(any(row['error'] for row in rows))


# Of each view: the function for a recording, the function for the table, the two files, the arguments of sheet().
VIEWS = {'compare': (compare, table, 'table.md', 'sheet.png', {}),
         'window': (compare_all, window_table, 'window.md', 'window.png', {'columns': 2}),
         'page': (on_page, page_table, 'page.md', 'sheet.png', {'columns': 8, 'width': 88, 'height': 66, 'gap': 3})}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('what', choices=['record', 'compare', 'window', 'speed', 'page', 'list'])
    parser.add_argument('names', nargs='*', metavar='NAME')
    parser.add_argument('-o', '--output', type=pathlib.Path, default=ROOT / 'out/programs')
    parser.add_argument('--seconds', type=float, default=6, help='of a recording')
    parser.add_argument('--first', type=int, default=0, help='frames of a recording that are kept; 0: all')
    parser.add_argument('--frame', type=int, default=100, help='that is compared, or three quarters of a shorter recording')
    parser.add_argument('--halfplane', type=pathlib.Path, default=ROOT / 'build/halfplane')
    parser.add_argument('--config', default='full')
    parser.add_argument('--set', action='append', default=[], help='key=value; stencil.bits=8 without one')
    parser.add_argument('--most', type=float, default=100, help='percent of differing pixels that is let through')
    parser.add_argument('--runs', type=int, default=3, help='of `speed` and `page`, on each of the two')
    parser.add_argument('--threads', type=int, default=2, help='of `speed`, likewise; of the driver in `window`')
    parser.add_argument('-j', '--jobs', type=int, default=1)
    options = parser.parse_intermixed_args()
    if Image is None:
        sys.exit('programs.py: this Python has no Pillow; install python3-pil')
    # `window`, `speed`, `page`: what a driver has that nobody has configured (gl/core/options.cpp).
    options.set = options.set or ['stencil.bits=8'] + ['perspective.colors=1', 'texture.unit=trilinear', 'alpha.unit=1',
                                                       'blend.lanes=4', 'fog.unit=1'] * (options.what != 'compare')
    look_for_savers()
    unknown = [name for name in options.names if name not in PROGRAMS]
    if unknown:
        sys.exit(f'programs.py: no program {", ".join(unknown)}; `programs.py list` names them')
    if options.what == 'list':
        for name, (command, package) in PROGRAMS.items():
            print(f'{name:20} {"yes" if shutil.which(command.split()[0]) else "no":4} {package:20} {command}')
        return 0
    folder = options.output.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    with Display() as display, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        if options.what == 'record':
            names = [name for name in options.names or PROGRAMS if shutil.which(PROGRAMS[name][0].split()[0])]
            for line in pool.map(lambda name: record(name, folder, display.name, options), names):
                print(line, flush=True)
            return 0
        names = [name for name in options.names or PROGRAMS if (folder / f'{name}.trace').exists()]
        env = environment(display.name, folder)
        if options.what == 'speed':
            return measure_speed(names, folder, env, options)
        look, lines, text, image, layout = VIEWS[options.what]
        rows = []
        for row in pool.map(lambda name: look(name, folder, env, options), names):
            rows.append(row)
            print(lines([row]).splitlines()[-1], flush=True)
    (folder / text).write_text(lines(rows), encoding='utf-8')
    groups = [[row.get('mesa'), row.get('ours')] for row in rows
              if options.what != 'page' or not row['error'] and not is_blank_in_both(row)]
    if options.what == 'window':  # with their differences, four times as large
        groups = [[a, b, gaps_of(a, b).point(lambda v: min(4 * v, 255))] if a and b else [a, b] for a, b in groups]
    if groups:
        sheet(groups, **layout).quantize(128).save(folder / image)
    return int(any(row['error'] or 100 * row['seen'] > options.most for row in rows))


if __name__ == '__main__':
    sys.exit(main())
