local t = {}
for k in pairs{a=1,b=2,[3]=4} do t[#t+1] = k end
table.sort(t, function(a, b) return tostring(a) < tostring(b) end)
print(("%5.2f %s"):format(math.sin(1), t), ("x"):rep(100), select("#", table.unpack(t)))
local s = "" while true do s = s .. random() end
