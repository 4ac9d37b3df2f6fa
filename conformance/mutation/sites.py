"""Finds what can be mutated in C++ sources, and puts calls of mutants.h in its place.

A site is an operator or a constant of a function body (an initialiser of a member, a table). What the compiler needs as a
constant - template arguments, sizes of arrays, case labels - stays as it is; the uses of a named constant are sites with one
number, so that the constant itself is what changes.
"""
import collections
import re

from clang import cindex

Kind = cindex.CursorKind
BINARY = {"+": "add", "-": "subtract", "*": "multiply", "/": "divide", "%": "remainder", "<<": "shift_left",
          ">>": "shift_right", "&": "bit_and", "|": "bit_or", "^": "bit_xor", "<": "less", "<=": "less_equal",
          ">": "greater", ">=": "greater_equal", "==": "equal", "!=": "not_equal", "&&": "operand", "||": "operand"}
ASSIGN = {"+=": "assign_add", "-=": "assign_subtract", "*=": "assign_multiply", "/=": "assign_divide",
          "%=": "assign_remainder", "<<=": "assign_shift_left", ">>=": "assign_shift_right", "&=": "assign_and",
          "|=": "assign_or", "^=": "assign_xor"}
FUNCTIONS = {Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.DESTRUCTOR, Kind.FUNCTION_TEMPLATE,
             Kind.CONVERSION_FUNCTION}
ASIDE = {Kind.ENUM_DECL, Kind.STATIC_ASSERT, Kind.TYPE_ALIAS_DECL, Kind.TYPEDEF_DECL, Kind.TYPE_ALIAS_TEMPLATE_DECL,
         Kind.TEMPLATE_NON_TYPE_PARAMETER, Kind.TEMPLATE_TYPE_PARAMETER, Kind.CXX_UNARY_EXPR, Kind.STRING_LITERAL,
         Kind.USING_DECLARATION, Kind.UNEXPOSED_ATTR, Kind.ALIGNED_ATTR}
NUMBER = re.compile(rb"(0[xX][0-9a-fA-F']+|[0-9][0-9']*)[uUlLzZ]*$|[0-9.][0-9.']*([eE][-+]?[0-9]+)?[fF]?$")
POINTERS = {cindex.TypeKind.POINTER, cindex.TypeKind.CONSTANTARRAY, cindex.TypeKind.INCOMPLETEARRAY,
            cindex.TypeKind.NULLPTR, cindex.TypeKind.RECORD}

# key: what shares a number; edits: (offset, order at one offset, bytes that go, text put there)
Site = collections.namedtuple("Site", "start end key what edits")


def opening(start, end, text, gone=0):
    return start, (2, start - end), gone, text


def closing(start, end, text):
    return end, (0, end - start), 0, text


class Finder:
    """Sites of one file, from the syntax tree of a unit that includes it."""

    def __init__(self, path, text):
        self.path, self.text = path, text
        self.sites = {}  # (start, end): Site
        self.tables = []  # edits

    def join(self, other):
        """Takes the sites that another unit showed."""
        self.sites = {**other.sites, **self.sites}
        self.tables = list(dict.fromkeys(self.tables + other.tables))

    def add(self, start, end, what, edits, key=None):
        self.sites.setdefault((start, end), Site(start, end, key or (start, end), what, edits))

    def span(self, cursor):
        extent = cursor.extent
        if extent.start.file is None or extent.start.file.name != self.path:
            return None
        return extent.start.offset, extent.end.offset

    def wrapped(self, start, end, call, rest=""):
        """Edits that make a call of what is between; `{}` is the number."""
        return [opening(start, end, "::mutants::%s({}, " % call), closing(start, end, rest + ")")]

    def constant(self, cursor, key=None):
        span = self.span(cursor)
        if span and (key or NUMBER.match(self.text[span[0]:span[1]])):
            what = self.text[span[0]:span[1]].decode()
            self.add(*span, what, self.wrapped(*span, "constant"), key)

    def operator(self, cursor, children):
        """(offset, spelling) of an operator between its operands."""
        left, right = self.span(children[0]), self.span(children[1])
        if not left or not right:
            return None
        between = self.text[left[1]:right[0]]
        found = re.match(rb"(?:\s|//[^\n]*\n|/\*.*?\*/)*([-+*/%<>&|^=!]+)", between)
        return (left[1] + found.start(1), found.group(1).decode()) if found else None

    def binary(self, cursor):
        children = list(cursor.get_children())
        span = self.span(cursor)
        at = self.operator(cursor, children) if len(children) == 2 and span else None
        if not at:
            return
        offset, spelling = at
        start, end = self.span(children[0])[0], self.span(children[1])[1]
        if (start, end) != span:
            return
        if spelling in ASSIGN:
            if children[0].type.get_canonical().kind not in POINTERS:
                self.call(start, end, offset, spelling, ASSIGN[spelling])
        elif spelling in ("&&", "||"):
            self.logic(start, end, offset, spelling)
        elif spelling in BINARY and not any(c.type.get_canonical().kind in POINTERS for c in children):
            self.call(start, end, offset, spelling, BINARY[spelling])

    def call(self, start, end, offset, spelling, name):
        self.add(start, end, spelling, self.wrapped(start, end, name) + [(offset, (1, 0), len(spelling), ",")])

    def logic(self, start, end, offset, spelling):
        operand = "::mutants::operand({}, static_cast<bool>("
        self.add(start, end, spelling,
                 [opening(start, end, "((" + operand), (offset, (1, 0), 2, ")) " + spelling + " " + operand),
                  closing(start, end, "))) != ::mutants::is_on({}))")])

    def unary(self, cursor, loops):
        span = self.span(cursor)
        child = next(iter(cursor.get_children()), None)
        inner = self.span(child) if child is not None else None
        if not span or not inner:
            return
        spelling = self.text[span[0]:inner[0]].decode().strip()
        names = {"-": "negate", "!": "invert"}
        if child.type.get_canonical().kind not in POINTERS and not loops:
            names.update({"++": "increment", "--": "decrement"})
        if spelling not in names or (spelling == "-" and NUMBER.match(self.text[inner[0]:inner[1]])):
            return
        argument = "static_cast<bool>(" if spelling == "!" else ""
        self.add(*span, spelling, [opening(*span, "::mutants::%s({}, %s" % (names[spelling], argument), len(spelling)),
                                   closing(*span, ")" * (2 if argument else 1))])

    def table(self, cursor, initialiser):
        """A table that the compiler makes becomes one that the start of the program makes."""
        span, whole = self.span(initialiser), self.span(cursor)
        head = self.text[whole[0]:span[0]]
        found = re.search(rb"\bconstexpr\b", head)
        equals = head.rstrip().endswith(b"=")
        if not found or not equals:
            return False
        at = whole[0] + found.start()
        listed = self.text[span[0]:span[0] + 1] == b"{"
        kind = re.search(rb"constexpr\s+(.*?)\s*(?:\w+::)*\w+\s*=\s*$", head, re.S)
        name = kind.group(1).decode() if kind and listed else ""
        if listed and (not name or "[" in name):
            return False
        # Outside of functions and classes, where tables that other files make may use it.
        first = self.text[whole[0] - 1:whole[0]] in (b"", b"\n") and b"auto" not in head
        self.tables += [(at, (1, 0), len("constexpr"), "__attribute__((init_priority(200))) const" if first else "const"),
                        (span[0], (2, -len(self.text)), 0, "::mutants::made_late(" + name),
                        (span[1], (0, len(self.text)), 0, ")")]
        return True

    def walk(self, cursor, loops=False):
        kind = cursor.kind
        if kind in ASIDE or kind.is_attribute():
            return
        if kind == Kind.INTEGER_LITERAL or kind == Kind.FLOATING_LITERAL:
            return self.constant(cursor)
        if kind == Kind.DECL_REF_EXPR:
            return self.named(cursor)
        if kind == Kind.VAR_DECL or kind == Kind.FIELD_DECL:
            return self.variable(cursor)
        if kind in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR):
            self.binary(cursor)
        elif kind == Kind.UNARY_OPERATOR:
            self.unary(cursor, loops)
        self.children(cursor)

    def children(self, cursor):
        kind, children = cursor.kind, list(cursor.get_children())
        if kind in FUNCTIONS:
            children = [c for c in children if c.kind in (Kind.PARM_DECL, Kind.COMPOUND_STMT) or
                        kind == Kind.CONSTRUCTOR]
        elif kind == Kind.CASE_STMT:
            children = children[1:]
        elif kind == Kind.IF_STMT and self.starts(cursor, rb"if\s+constexpr"):
            children = children[1:]
        elif kind == Kind.MEMBER_REF_EXPR:
            children = children[:1]
        elif kind == Kind.FOR_STMT:
            body = self.span(children[-1])
            for c in children:
                span = self.span(c)
                self.walk(c, loops=bool(span and body and span[1] < body[0]))
            return
        for c in children:
            self.walk(c)

    def starts(self, cursor, pattern):
        span = self.span(cursor)
        return span and re.match(pattern, self.text[span[0]:span[0] + 40])

    def variable(self, cursor):
        """Its initialiser: what stands behind the name and the sizes of arrays."""
        children = list(cursor.get_children())
        span = self.span(cursor)
        name = cursor.location.offset + len(cursor.spelling)
        if not span or not children:
            return
        after = re.match(rb"(?:\s*\[[^\]]*\])*\s*(=|\{|\()?", self.text[name:span[1]])
        if not after or not after.group(1):
            return
        begins = name + after.start(1)
        values = [c for c in children if self.span(c) and self.span(c)[0] >= begins]
        constant = b"constexpr" in self.text[span[0]:name]
        if constant and (is_number(cursor) or not values or not self.table(cursor, values[-1])):
            return
        for c in values:
            self.walk(c)

    def named(self, cursor):
        """The use of a constant with a name."""
        target = cursor.referenced
        if target is None or target.kind != Kind.VAR_DECL or not is_number(target) or not target.location.file:
            return
        tokens = "".join(t.spelling + " " for t in target.get_tokens())
        if "constexpr" not in tokens.split("=")[0] or "/usr/" in target.location.file.name:
            return
        span = self.span(cursor)
        if span and self.text[span[0]:span[1]].decode("utf8", "replace").endswith(target.spelling):
            self.constant(cursor, key=("named", target.location.file.name, target.location.offset))


def is_number(cursor):
    kind = cursor.type.get_canonical().kind
    return cindex.TypeKind.BOOL.value < kind.value <= cindex.TypeKind.FLOAT128.value


def find(units, arguments, wanted):
    """{path: Finder} of the files of `wanted` (path: text) that these units include."""
    found = {}
    index = cindex.Index.create()
    for unit in units:
        tree = index.parse(str(unit), args=arguments)
        for fault in [d for d in tree.diagnostics if d.severity >= cindex.Diagnostic.Error][:3]:
            print("%s: %s" % (unit, fault.spelling))
        for cursor in tree.cursor.get_children():
            file = cursor.location.file
            if file is not None and file.name in wanted:
                finder = found.setdefault(file.name, Finder(file.name, wanted[file.name]))
                walk_scope(finder, cursor)
    return found


SCOPES = {Kind.NAMESPACE, Kind.LINKAGE_SPEC, Kind.UNEXPOSED_DECL, Kind.CLASS_DECL, Kind.STRUCT_DECL,
          Kind.CLASS_TEMPLATE, Kind.CLASS_TEMPLATE_PARTIAL_SPECIALIZATION}


def walk_scope(finder, cursor):
    if cursor.kind in SCOPES:
        for child in cursor.get_children():
            walk_scope(finder, child)
    elif cursor.kind in FUNCTIONS or cursor.kind in (Kind.VAR_DECL, Kind.FIELD_DECL):
        finder.walk(cursor)


def rewrite(text, edits):
    """The text with its edits; of those at one place, what closes goes before what opens."""
    out, last = [], 0
    for offset, _, gone, put in sorted(edits, key=lambda e: e[:2]):
        out += [text[last:offset], put.encode()]
        last = max(last, offset + gone)
    return b"".join(out) + text[last:]
