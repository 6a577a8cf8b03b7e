"""Prints a C program that compiles and ends with 0 where all that whit.py says of whit.h is so: enumerators, sizes and
offsets of structs, types of their members, prototypes, version. Ends with an error where the headers have members or
enumerators that whit.py lacks: layout.py HEADER...; PYTHONPATH has whit.py."""

import ctypes
import re
import sys

import whit

NAMES = {ctypes.c_bool: "_Bool", ctypes.c_char: "char", ctypes.c_char_p: "const char *", ctypes.c_double: "double",
         ctypes.c_float: "float", ctypes.c_uint: "unsigned", ctypes.c_uint8: "uint8_t", ctypes.c_uint32: "uint32_t",
         ctypes.c_uint64: "uint64_t", ctypes.POINTER(ctypes.c_char_p): "const char *const *"}


def name_of(kind):
    """The C type of a member's value; of an array that of a pointer to its first. None: any pointer."""
    if isinstance(kind, type(ctypes.c_uint8 * 3)):
        return NAMES[kind._type_] + " *"
    if isinstance(kind, type(whit.Result)) or kind in whit.STRUCTS:
        return c_name(kind)
    return NAMES.get(kind)


def c_name(kind):
    """whit_scene_info of SceneInfo."""
    return "whit" + re.sub("([A-Z])", r"_\1", kind.__name__).lower()


def names_in(kind, text):
    """The members or enumerators of the struct or enumeration in the text of the headers."""
    body = re.search(r"typedef (?:struct|enum) " + kind + r" \{(.*?)\} " + kind + ";", text, re.S).group(1)
    body = re.sub(r"\(\*(\w+)\)\(.*?\)|=[^,]*|\[.*?\]", r" \1", body, flags=re.S)
    return re.findall(r"(\w+)\s*(?=[,;]|$)", body)


def hold(condition, what):
    print(f'_Static_assert({condition}, "{what}");')


print('#include <stddef.h>\n#include <string.h>\n\n#include "whit/whit.h"\n' + whit.PROTOTYPES)
enumerations = [kind for kind in vars(whit).values() if isinstance(kind, type(whit.Result)) and len(kind)]
assert len(enumerations) >= 14 and len(whit.STRUCTS) >= 13 and whit.PROTOTYPES.count(";") >= 23
headers = re.sub(r"/\*.*?\*/", "", "".join(open(path, encoding="utf-8").read() for path in sys.argv[1:]), flags=re.S)
for kind in enumerations:
    own = [f"{whit.PREFIXES.get(kind, c_name(kind).upper())}_{word}" for word in kind.__members__]
    assert set(names_in(c_name(kind), headers)) - set(own) <= {"WHIT_AOV_SHADER"}, (kind, own)
for struct in whit.STRUCTS:
    assert names_in(c_name(struct), headers) == list(struct.kinds), (struct, names_in(c_name(struct), headers))
for kind in enumerations:
    for word, value in kind.__members__.items():
        enumerator = f"{whit.PREFIXES.get(kind, c_name(kind).upper())}_{word}"
        hold(f"{enumerator} == {int(value)}", f"{enumerator} is {int(value)} in whit.py")
    enumerator = f"sizeof({c_name(kind)}) == {ctypes.sizeof(ctypes.c_uint)}"
    hold(enumerator, enumerator)
hold(f"WHIT_NONE == {whit.NONE}u", "NONE")
for struct in whit.STRUCTS:
    of = c_name(struct)
    hold(f"sizeof({of}) == {ctypes.sizeof(struct)}", f"{of}: its size")
    for member, kind in struct.kinds.items():
        field, value = getattr(struct, member), f"(({of} *)0)->{member}"
        hold(f"offsetof({of}, {member}) == {field.offset}", f"{of}.{member}: its place")
        hold(f"sizeof {value} == {field.size}", f"{of}.{member}: its size")
        if name_of(kind):
            hold(f"_Generic({value}, {name_of(kind)}: 1, default: 0)", f"{of}.{member}: its type")
print(f'int main(void)\n{{\n    return strcmp(WHIT_VERSION, "{whit.VERSION}") != 0;\n}}')
