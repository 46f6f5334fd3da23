# layers.awk - arrows between the folders of src/ that run upward.
#
# Arguments: layers.txt, then a list of arrows, one a line: "include FILE FILE" or "call FILE FILE NAME", the first of
# which needs the second. Prints each arrow that runs up the list of layers. Where none does, no circle of calls goes
# through two folders.

FILENAME == ARGV[1] { if (!/^#/ && NF > 0) rank[$1] = ++layers; next }
{
    from = folder_of($2); to = folder_of($3)
    for (i = 2; i <= 3; ++i) {
        if (!(folder_of($i) in rank) && !($i in told)) { told[$i]; print $i ": the folder is not in tools/lint/layers.txt" }
    }
    if (rank[to] > rank[from]) { print $2 " needs " $3 ($4 == "" ? "" : " (" $4 ")") ": " to " lies above " from }
}

function folder_of(file,    part) { split(file, part, "/"); return part[2] }
