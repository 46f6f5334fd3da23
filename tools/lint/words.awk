# words.awk - what comments and READMEs name and is nowhere: files, our identifiers, functions called name().
#
# Arguments: a list of all file names, one of all identifiers in code, then the texts. Of a source only what follows
# // is a comment. Not looked at: what stands for many (pl_..., X.simd.c), and names of the amalgamation.

FILENAME == ARGV[1] { files[$0] = 1; next }
FILENAME == ARGV[2] { words[$0] = 1; next }
{
    text = $0
    if (FILENAME !~ /\.md$/ && !sub(/^.*\/\/+/, "", text)) {
        next
    }
    look(text, "[A-Za-z0-9_]+(\\.simd)?\\.(c|h|sh|mk)[^A-Za-z0-9_(]", "file")
    look(text, "(pl|plumb|PL|PLUMB)_[A-Za-z0-9_]*[^A-Za-z0-9_]", "word")
    look(text, "[a-z][A-Za-z0-9_]*\\(\\)", "call")
}

function look(text, pattern, kind,    name, before)
{
    text = " " text " "
    while (match(text, pattern)) {
        before = substr(text, RSTART - 1, 1)
        name = substr(text, RSTART, RLENGTH - (kind == "call" ? 2 : 1))
        text = substr(text, RSTART + RLENGTH - 1)
        if (before ~ /[A-Za-z0-9_.*]/) {
            continue
        }
        if (kind == "file" ? name in files || name ~ /^(_.*|(x|X|plumb|cmd_name)\..*)$/ : is_known(name)) {
            continue
        }
        print FILENAME ":" FNR ": " name
    }
}

# In code, with or without an ending that is put on by ##; or left open, for many names.
function is_known(name)
{
    if (name in words || name ~ /_$/) {
        return 1
    }
    sub(/_(float|double|far|w4|w8|w16)$/, "", name)
    return name in words
}
