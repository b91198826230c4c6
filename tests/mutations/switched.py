"""Faults as branches of the functions that they change: one build holds many, and an environment variable chooses the one that is there.

A function `fn f(…) -> T { body }` with the faults 3 and 7 becomes `fn f(…) -> T { match number() { 3 => { body with 3 }, 7 => { body with 7 },
_ => { body } } }`. A fault fits where it lies inside the body of one function that is neither `const` nor returns an `impl` type, since branches
of one function have one type.
"""

import re

# The variable that chooses a fault by its number; without it none is there.
VARIABLE = "SUPEL_FAULT"

# Added to the root of every crate that has faults. The allocator of the program calls it, so that it allocates nothing.
CHOICE = f"""
#[allow(missing_docs, unsafe_code, unused)]
mod chosen_fault {{
    use core::sync::atomic::{{AtomicUsize, Ordering}};

    const UNKNOWN: usize = usize::MAX;
    static NUMBER: AtomicUsize = AtomicUsize::new(UNKNOWN);

    unsafe extern "C" {{
        fn getenv(name: *const core::ffi::c_char) -> *const core::ffi::c_char;
    }}

    pub(crate) fn number() -> usize {{
        match NUMBER.load(Ordering::Relaxed) {{
            UNKNOWN => read(),
            known => known,
        }}
    }}

    #[cold]
    fn read() -> usize {{
        // SAFETY: the name ends with a zero, and nothing changes the environment while a program of tests starts.
        let value = unsafe {{ getenv(c"{VARIABLE}".as_ptr()) }};
        // SAFETY: what `getenv` found ends with a zero.
        let text = (!value.is_null()).then(|| unsafe {{ core::ffi::CStr::from_ptr(value) }});
        let number = text.and_then(|text| text.to_str().ok()?.parse().ok()).unwrap_or(0);
        NUMBER.store(number, Ordering::Relaxed);
        number
    }}
}}
"""

MARK = re.compile(r"/\* fault (\d+|none of ([\d ]+)) \*/")

# Comments, strings and characters: braces in them are none.
NO_CODE = re.compile(
    r"""//[^\n]* | /\*.*?\*/ | b?c?r(?P<hashes>\#*)".*?"(?P=hashes) | b?c?"(?:\\.|[^"\\])*" | b?'(?:\\u\{[^}]*\}|\\[^u]|[^'\\])'""",
    re.S | re.X,
)


def code_alone(text):
    """The text with blanks in the place of comments, strings and characters."""
    return NO_CODE.sub(lambda found: re.sub(r"[^\n]", " ", found[0]), text)


def bodies(text):
    """Start and end of what stands between the braces of every function that may branch."""
    code = code_alone(text)
    for head in re.finditer(r"\bfn\s+\w+", code):
        depth, at = 0, head.end()
        while at < len(code) and not (depth == 0 and code[at] in "{;"):
            depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(code[at], 0)
            at += 1
        signature = code[code.rfind("\n", 0, head.start()) + 1 : at]
        if at == len(code) or code[at] == ";" or re.search(r"\bconst\s+(unsafe\s+)?fn\b|->\s*impl\b", signature):
            continue
        start, depth = at + 1, 1
        while depth:
            at += 1
            depth += {"{": 1, "}": -1}.get(code[at], 0)
        yield start, at


def place(text, mutation):
    """The body of the innermost function that holds all that a fault changes, or None."""
    first = text.index(mutation["before"])
    last = first + len(mutation["before"])
    around = [body for body in bodies(text) if body[0] <= first and last <= body[1]]
    return max(around, default=None)


def switched(text, faults):
    """The text of a file with its faults, (number, mutation) each, as branches, and the numbers of those that fit."""
    by_body = {}
    for number, mutation in faults:
        body = place(text, mutation)
        if body is not None:
            by_body.setdefault(body, []).append((number, mutation))
    # A function inside another that has faults of its own would stand in several branches.
    apart = [body for body in by_body if not any(other != body and other[0] <= body[0] <= other[1] for other in by_body)]
    fitting = set()
    for start, end in sorted(apart, reverse=True):
        body, here = text[start:end], by_body[start, end]
        numbers = [number for number, _ in here]
        branches = "".join(
            f"/* fault {number} */ {number} => {{{body.replace(mutation['before'], mutation['after'])}\n}}\n" for number, mutation in here
        )
        rest = f"/* fault none of {' '.join(map(str, numbers))} */ _ => {{{body}\n}}\n"
        text = f"{text[:start]}\nmatch crate::chosen_fault::number() {{\n{branches}{rest}}}\n{text[end:]}"
        fitting.update(numbers)
    return text, fitting


def faults_at(text, line):
    """The numbers of the faults whose branches, or the sound one next to them, are in a line of a switched file."""
    lines = text.splitlines()[:line]
    for earlier in reversed(lines):
        found = MARK.search(earlier)
        if found:
            return [int(number) for number in (found[2] or found[1]).split()]
    return []
