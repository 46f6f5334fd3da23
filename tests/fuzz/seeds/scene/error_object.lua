local s = ("("):rep(1000) .. ("{"):rep(300)
error({})