# layers.awk - arrows between the folders of src/, and circles of calls.
#
# Arguments: layers.txt, upward.txt, then a list of arrows, one a line: "include FILE FILE" or "call FILE FILE NAME", the
# first of which needs the second. Prints each arrow that runs up the list of layers and is not in upward.txt, each row of
# upward.txt that no arrow needs any more, and, where it is not what upward.txt says, how many files the largest circle of
# calls across folders has (Tarjan 1972). Ratchets: upward.txt may only get shorter.

FILENAME == ARGV[1] { if (!/^#/ && NF > 0) rank[$1] = ++layers; next }
FILENAME == ARGV[2] {
    if ($1 == "circle") { circle = $2 }
    else if (!/^#/ && NF > 0) { still[$1 " " $2] }
    next
}
{
    from = folder_of($2); to = folder_of($3)
    if ($1 == "call" && !(($2, $3) in called)) {
        called[$2, $3]
        calls[$2] = calls[$2] " " $3
        files[$2]; files[$3]
    }
    if (from == to) { next }
    for (i = 2; i <= 3; ++i) {
        if (!(folder_of($i) in rank) && !($i in told)) { told[$i]; print $i ": the folder is not in tools/lint/layers.txt" }
    }
    if (rank[to] > rank[from]) {
        if ((from " " to) in still) { needed[from " " to] }
        else { print $2 " needs " $3 ($4 == "" ? "" : " (" $4 ")") ": " to " lies above " from }
    }
}
END {
    for (arrow in still) {
        if (!(arrow in needed)) { print "tools/lint/upward.txt: " arrow ": nothing needs this any more, take it out" }
    }
    for (file in files) { if (!(file in order)) { visit(file) } }
    if (largest + 0 != circle + 0) {
        print "the largest circle of calls across folders has " largest + 0 " files; tools/lint/upward.txt says " circle + 0
    }
}

function folder_of(file,    part) { split(file, part, "/"); return part[2] }

function visit(file,    n, next_ones, i, at, count, first, across) {
    order[file] = low[file] = ++visited
    stack[++top] = file; on[file]
    n = split(calls[file], next_ones, " ")
    for (i = 1; i <= n; ++i) {
        if (!(next_ones[i] in order)) {
            visit(next_ones[i])
            low[file] = low[next_ones[i]] < low[file] ? low[next_ones[i]] : low[file]
        } else if (next_ones[i] in on) {
            low[file] = order[next_ones[i]] < low[file] ? order[next_ones[i]] : low[file]
        }
    }
    if (low[file] < order[file]) { return }
    do {
        at = stack[top--]; delete on[at]; ++count
        first = first == "" ? folder_of(at) : first
        across = across || folder_of(at) != first
    } while (at != file)
    if (across && count > largest) { largest = count }
}
