-- chain_grid.lua - a cloth of 20 by 20 discs hung by two corners, double gravity (Joint Grid of Solver2D and Box2D:
-- "may blow up some solvers"). Fails: PGS and NGS in pairs gain energy. Right: nothing flies, no thread opens widely.
scene { title = "Joint grid", gravity = {0, -19.62}, duration = 4 }
local n = param("n", 20, 2, 40)
local rows = {}
for i = 1, n do
    rows[i] = {}
    for j = 1, n do
        local fixed = j == 1 and (i == 1 or i == n)
        rows[i][j] = body { name = ("disc%d_%d"):format(i, j), type = fixed and "static" or "dynamic", circle { 0.4 },
                            at = {i, -j}, apart = "cloth" }
        if j > 1 then revolute { rows[i][j - 1], rows[i][j], at = {i, 0.5 - j} } end
        if i > 1 then revolute { rows[i - 1][j], rows[i][j], at = {i - 0.5, -j} } end
    end
end
expect { "nothing flies up", always = true, body = "disc*", y = {-3 * n, 0.5} }
expect { "no thread opens by half", always = true, max_joint_error = 0.5 }
expect { "no thread is open in the end", max_joint_error = 0.1 }
