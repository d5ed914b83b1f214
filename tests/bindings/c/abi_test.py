"""The interface of libvmech_c is the one that is written down, function by function and field by
field: abi_test.py CC LIBRARY HEADER RECORDED [--record]

The library and every program are compiled with the same header. What is compared is its binary
interface, that of a library which defines every function of the header and does nothing; and the
real one must export the same functions. After a change that is meant, --record writes it down:
functions may be added, and fields at the end of a structure; anything else asks for another soname.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
DECLARATION = re.compile(r"^VMECH_API ([^;]*\b(vmech_\w+)\([^;]*\));", re.MULTILINE)


def output_of(*command, folder=None):
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True,
                          cwd=folder).stdout


def compile_interface(compiler, header, library, soname):
    """A library of the header's functions; their names."""
    declarations = DECLARATION.findall(COMMENT.sub("", header.read_text()))
    library.with_suffix(".c").write_text('#include "vmech.h"\n' + "".join(
        f"{signature} {{ __builtin_trap(); }}\n" for signature, _ in declarations))
    output_of(compiler, "-std=c99", "-g2", "-gdwarf-4", "-O0", "-shared", "-fPIC", "-I",
              header.parent, f"-Wl,-soname,{soname}", "-o", library.name, f"{library.stem}.c",
              folder=library.parent)
    return {name for _, name in declarations}


def exports(library):
    """What a library defines for others, but the name of its version."""
    lines = output_of("nm", "-D", "--defined-only", library).splitlines()
    return {line.split()[-1].partition("@")[0] for line in lines} - {"VMECH_C_0"}


def soname_of(library):
    return re.search(r"soname: \[(.*)\]", output_of("readelf", "-d", library))[1]


def main():
    compiler, library = sys.argv[1:3]
    header, recorded = (pathlib.Path(path).resolve() for path in sys.argv[3:5])
    with tempfile.TemporaryDirectory() as folder:
        interface = pathlib.Path(folder) / "interface.so"
        declared = compile_interface(compiler, header, interface, soname_of(library))
        if "--record" in sys.argv:
            recorded.write_text(output_of("abidw", "--no-show-locs", "--no-comp-dir-path",
                                          "--no-corpus-path", interface))
        status = subprocess.run(["abidiff", "--no-show-locs", recorded, interface]).returncode
    if status != 0:
        sys.exit(f"abidiff ended with {status}: the interface is not the recorded one. If that is "
                 "meant, run this with --record, and see what else has to change.")
    if exports(library) != declared:
        sys.exit(f"the library does not export what the header declares: "
                 f"{exports(library) ^ declared}")
    print(f"{len(declared)} functions, as recorded")


main()
